import { Button } from "@mantine/core";
import { useEffect, useState, type ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";

const FORGET_AFTER_MS = 6000;

interface ConfirmOrCancelButtonProps {
  children: ReactNode;
  /** Label of the second touch, such as "Yes, replace version 2". */
  confirmLabel: string;
  /** Without it the first touch acts. */
  needsConfirmation: boolean;
  onConfirm: () => void;
  disabled?: boolean;
  busy?: boolean;
  variant?: "filled" | "default";
  testId?: string;
}

/** A button that needs a second touch, for actions that cannot be undone. */
export function ConfirmOrCancelButton({
  children,
  confirmLabel,
  needsConfirmation,
  onConfirm: onSure,
  disabled = false,
  busy = false,
  variant = "filled",
  testId,
}: ConfirmOrCancelButtonProps): ReactNode {
  const texts = useTexts().registration;
  const [isAsking, setIsAsking] = useState(false);
  useEffect(() => {
    if (!isAsking) return;
    const timer = setTimeout(() => {
      setIsAsking(false);
    }, FORGET_AFTER_MS);
    return () => {
      clearTimeout(timer);
    };
  }, [isAsking]);

  if (!isAsking || disabled)
    return (
      <Button
        size="lg"
        variant={variant}
        disabled={disabled}
        loading={busy}
        data-testid={testId}
        onClick={() => {
          if (needsConfirmation) setIsAsking(true);
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
          setIsAsking(false);
          onSure();
        }}
      >
        {confirmLabel}
      </Button>
      <Button
        size="lg"
        variant="default"
        onClick={() => {
          setIsAsking(false);
        }}
      >
        {texts.no}
      </Button>
    </div>
  );
}
