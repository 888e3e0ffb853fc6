import { useEffect, useState, type ReactNode } from "react";

const BACK_AFTER_MS = 5000;

interface TwoStepsProps {
  first: string;
  second: string;
  className?: string;
  testid: string;
  busy: boolean;
  onDone: () => void;
}

/** A button that asks once more, so that a slip does nothing; left alone it goes back. */
export function TwoSteps({ first, second, className = "", testid, busy, onDone }: TwoStepsProps): ReactNode {
  const [asks, setAsks] = useState(false);
  useEffect(() => {
    if (!asks) return;
    const timer = setTimeout(() => {
      setAsks(false);
    }, BACK_AFTER_MS);
    return () => {
      clearTimeout(timer);
    };
  }, [asks]);
  return (
    <button
      type="button"
      className={`two-steps ${className}`}
      data-testid={testid}
      data-asks={asks}
      disabled={busy}
      onClick={() => {
        setAsks(!asks);
        if (asks) onDone();
      }}
    >
      <span aria-live="polite">{asks ? second : first}</span>
    </button>
  );
}
