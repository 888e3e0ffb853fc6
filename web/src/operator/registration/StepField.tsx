import { Button, NumberInput } from "@mantine/core";
import type { ReactNode } from "react";
import { formatExact } from "../../live/rounding";

interface StepFieldProps {
  label: string;
  value: number;
  min: number;
  max: number;
  step: number;
  onValue: (value: number) => void;
  testId: string;
}

/** A number between two large buttons, for use with gloves. */
export function StepField({ label, value, min, max, step, onValue, testId }: StepFieldProps): ReactNode {
  const by = (way: number) => () => {
    onValue(Math.min(max, Math.max(min, value + way * step)));
  };
  return (
    <div className="step-field">
      <Button size="lg" variant="default" aria-label={`${label} − ${formatExact(step)}`} onClick={by(-1)}>
        −
      </Button>
      <NumberInput
        size="lg"
        label={label}
        value={value}
        min={min}
        max={max}
        hideControls
        clampBehavior="blur"
        inputMode="decimal"
        data-testid={testId}
        onChange={(given) => {
          if (typeof given === "number" && given >= min && given <= max) onValue(given);
        }}
      />
      <Button size="lg" variant="default" aria-label={`${label} + ${formatExact(step)}`} onClick={by(1)}>
        +
      </Button>
    </div>
  );
}
