import { Button } from "@mantine/core";
import { useEffect, useState, type ReactNode } from "react";

const FORGET_AFTER_MS = 5000;

interface ConfirmButtonProps {
  /** Label of the second touch. */
  confirmLabel: string;
  color?: string;
  variant?: string;
  loading?: boolean;
  testId?: string;
  onConfirm: () => void;
  children: ReactNode;
}

/** A button that acts on the second touch, so that a slip has no effect. */
export function ConfirmButton(props: ConfirmButtonProps): ReactNode {
  const {
    confirmLabel,
    color = "gray",
    variant = "default",
    loading = false,
    testId,
    onConfirm: onTwice,
    children,
  } = props;
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
  return (
    <Button
      size="lg"
      variant={isAsking ? "filled" : variant}
      color={isAsking ? "red" : color}
      loading={loading}
      data-testid={testId}
      onClick={() => {
        setIsAsking(!isAsking);
        if (isAsking) onTwice();
      }}
    >
      {isAsking ? confirmLabel : children}
    </Button>
  );
}
