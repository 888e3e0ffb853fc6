import { Button } from "@mantine/core";
import { useEffect, useState, type ReactNode } from "react";

const FORGET_AFTER_MS = 5000;

interface TwiceButtonProps {
  /** What the second touch says that it does. */
  again: string;
  color?: string;
  variant?: string;
  loading?: boolean;
  testId?: string;
  onTwice: () => void;
  children: ReactNode;
}

/** Does what it says with the second touch, so that a slip of the hand does nothing. */
export function TwiceButton(props: TwiceButtonProps): ReactNode {
  const { again, color = "gray", variant = "default", loading = false, testId, onTwice, children } = props;
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
  return (
    <Button
      size="lg"
      variant={asked ? "filled" : variant}
      color={asked ? "red" : color}
      loading={loading}
      data-testid={testId}
      onClick={() => {
        setAsked(!asked);
        if (asked) onTwice();
      }}
    >
      {asked ? again : children}
    </Button>
  );
}
