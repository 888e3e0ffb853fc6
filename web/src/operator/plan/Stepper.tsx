import type { ReactNode } from "react";
import { useWords } from "../../words/WordsContext";

interface StepperProps {
  name: string;
  label: string;
  /** As it is shown, with its unit. */
  value: string;
  disabled?: boolean;
  onStep: (direction: 1 | -1) => void;
}

/** A number with a button for less and one for more: nothing to type in gloves. */
export function Stepper({ name, label, value, disabled = false, onStep }: StepperProps): ReactNode {
  const words = useWords().plan;
  return (
    <div className="stepper" role="group" aria-label={label}>
      <span className="stepper-label">{label}</span>
      <button
        type="button"
        disabled={disabled}
        aria-label={`${label}: ${words.less}`}
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
        disabled={disabled}
        aria-label={`${label}: ${words.more}`}
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
