import { Button } from "@mantine/core";
import { useEffect, useState, type ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";

const FORGET_AFTER_MS = 6000;

interface SureButtonProps {
  children: ReactNode;
  /** What the second touch says, such as "Yes, end version 2". */
  sure: string;
  /** Without it the first touch is enough. */
  ask: boolean;
  onSure: () => void;
  disabled?: boolean;
  busy?: boolean;
  variant?: "filled" | "default";
  testId?: string;
}

/** For what cannot be taken back by a second touch: a glove that slips does nothing. */
export function SureButton({
  children,
  sure,
  ask,
  onSure,
  disabled = false,
  busy = false,
  variant = "filled",
  testId,
}: SureButtonProps): ReactNode {
  const texts = useTexts().registration;
  const [asked, setAsked] = useState(false);
  useEffect(() => {
    if (!asked) return;
    const timer = setTimeout(() => {
      setAsked(false);
    }, FORGET_AFTER_MS);
    return () => {
      clearTimeout(timer);
    };
  }, [asked]);

  if (!asked || disabled)
    return (
      <Button
        size="lg"
        variant={variant}
        disabled={disabled}
        loading={busy}
        data-testid={testId}
        onClick={() => {
          if (ask) setAsked(true);
          else onSure();
        }}
      >
        {children}
      </Button>
    );
  return (
    <div className="sure" role="group">
      <Button
        size="lg"
        color="yellow"
        variant="outline"
        data-testid={testId === undefined ? undefined : `${testId}-sure`}
        onClick={() => {
          setAsked(false);
          onSure();
        }}
      >
        {sure}
      </Button>
      <Button
        size="lg"
        variant="default"
        onClick={() => {
          setAsked(false);
        }}
      >
        {texts.no}
      </Button>
    </div>
  );
}
