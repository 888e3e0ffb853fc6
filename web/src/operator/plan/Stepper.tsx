import type { ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";

interface StepperProps {
  name: string;
  label: string;
  /** Formatted value with unit. */
  value: string;
  disabled?: boolean;
  /** Whether there is a smaller or larger value. */
  hasLess?: boolean;
  hasMore?: boolean;
  onStep: (direction: 1 | -1) => void;
}

/** A number with buttons to decrease and increase it, for use with gloves. */
export function Stepper({
  name,
  label,
  value,
  disabled = false,
  hasLess = true,
  hasMore = true,
  onStep,
}: StepperProps): ReactNode {
  const texts = useTexts().plan;
  return (
    <div className="stepper" role="group" aria-label={label}>
      <span className="stepper-label">{label}</span>
      <button
        type="button"
        disabled={disabled || !hasLess}
        aria-label={`${label}: ${texts.less}`}
        data-testid={`${name}-less`}
        onClick={() => {
          onStep(-1);
        }}
      >
        −
      </button>
      <output>{value}</output>
      <button
        type="button"
        disabled={disabled || !hasMore}
        aria-label={`${label}: ${texts.more}`}
        data-testid={`${name}-more`}
        onClick={() => {
          onStep(1);
        }}
      >
        +
      </button>
    </div>
  );
}
