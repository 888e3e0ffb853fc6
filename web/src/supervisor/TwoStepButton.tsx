import { useEffect, useState, type ReactNode } from "react";

const BACK_AFTER_MS = 5000;

interface TwoStepButtonProps {
  first: string;
  second: string;
  className?: string;
  testid: string;
  busy: boolean;
  onDone: () => void;
}

/** A button that asks for confirmation, and resets if it gets none. */
export function TwoStepButton({
  first,
  second,
  className = "",
  testid,
  busy,
  onDone,
}: TwoStepButtonProps): ReactNode {
  const [isAsking, setIsAsking] = useState(false);
  useEffect(() => {
    if (!isAsking) return;
    const timer = setTimeout(() => {
      setIsAsking(false);
    }, BACK_AFTER_MS);
    return () => {
      clearTimeout(timer);
    };
  }, [isAsking]);
  return (
    <button
      type="button"
      className={`two-steps ${className}`}
      data-testid={testid}
      data-asks={isAsking}
      disabled={busy}
      onClick={() => {
        setIsAsking(!isAsking);
        if (isAsking) onDone();
      }}
    >
      <span aria-live="polite">{isAsking ? second : first}</span>
    </button>
  );
}
