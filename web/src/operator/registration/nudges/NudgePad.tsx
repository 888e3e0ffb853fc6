import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import type { NudgeAxis, NudgeKind } from "../../../api";
import { useTexts } from "../../../texts/TextsContext";

export type Kind = NudgeKind;
export type Axis = NudgeAxis;
/** The two directions of each axis, negative first. */
const AXES: readonly Axis[] = ["left", "back", "head"];

interface NudgePadProps {
  kind: Kind;
  disabled: boolean;
  onNudge: (axis: Axis, way: 1 | -1) => void;
}

/** Six directions of the patient. */
export function NudgePad({ kind, disabled, onNudge }: NudgePadProps): ReactNode {
  const texts = useTexts().registration.nudges;
  return (
    <div className="nudge-pad" role="group" aria-label={texts.pad}>
      {AXES.flatMap((axis) =>
        ([-1, 1] as const).map((way) => (
          <Button
            key={`${axis} ${way}`}
            size="lg"
            variant="default"
            disabled={disabled}
            data-testid={`nudge-${axis}-${way > 0 ? "plus" : "minus"}`}
            onClick={() => {
              onNudge(axis, way);
            }}
          >
            {texts[kind === "shift" ? "shiftTo" : "turnTo"][axis][way > 0 ? "plus" : "minus"]}
          </Button>
        )),
      )}
    </div>
  );
}
