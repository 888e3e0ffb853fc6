import type { ReactNode } from "react";
import { useTexts } from "../../../texts/TextsContext";

const ARROWS = [
  { way: "up", sign: "▲", right: 0, down: -1 },
  { way: "left", sign: "◀", right: -1, down: 0 },
  { way: "right", sign: "▶", right: 1, down: 0 },
  { way: "down", sign: "▼", right: 0, down: 1 },
] as const;

interface ArrowPadProps {
  name: string;
  label: string;
  disabled?: boolean;
  /** Steps to the right and down in the large picture. */
  onMove: (right: number, down: number) => void;
}

/** Four buttons, each as large as a gloved finger. */
export function ArrowPad({ name, label, disabled = false, onMove }: ArrowPadProps): ReactNode {
  const texts = useTexts().plan.arrows;
  return (
    <div className="arrow-pad" role="group" aria-label={label}>
      {ARROWS.map(({ way, sign, right, down }) => (
        <button
          key={way}
          type="button"
          data-way={way}
          data-testid={`${name}-${way}`}
          disabled={disabled}
          aria-label={`${label}: ${texts[way]}`}
          onClick={() => {
            onMove(right, down);
          }}
        >
          {sign}
        </button>
      ))}
    </div>
  );
}
