import { SegmentedControl } from "@mantine/core";
import type { ReactNode } from "react";
import { useWords } from "../../../words/WordsContext";
import { usePlanning } from "../state/PlanContext";

/** Of the patient; the right one first, because it stands on the left of an axial slice. */
export function SideChooser(): ReactNode {
  const words = useWords().plan.side;
  const { side, setSide } = usePlanning();
  return (
    <SegmentedControl
      size="lg"
      fullWidth
      value={side}
      aria-label={words.title}
      data-testid="side"
      data={[
        { value: "right" as const, label: words.right },
        { value: "left" as const, label: words.left },
      ]}
      onChange={setSide}
    />
  );
}
