import { SegmentedControl } from "@mantine/core";
import type { ReactNode } from "react";
import { useTexts } from "../../../texts/TextsContext";
import { usePlanning } from "../state/PlanContext";

/** Side of the patient; right first, because it is on the left of an axial slice. */
export function SideChooser(): ReactNode {
  const texts = useTexts().plan.side;
  const { side, setSide } = usePlanning();
  return (
    <SegmentedControl
      size="lg"
      fullWidth
      value={side}
      aria-label={texts.title}
      data-testid="side"
      data={[
        { value: "right" as const, label: texts.right },
        { value: "left" as const, label: texts.left },
      ]}
      onChange={setSide}
    />
  );
}
