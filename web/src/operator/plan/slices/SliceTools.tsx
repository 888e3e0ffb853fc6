import { Button, Popover, SegmentedControl } from "@mantine/core";
import type { ReactNode } from "react";
import { useTexts } from "../../../texts/TextsContext";
import { Greys } from "./Greys";
import { useSlices, type Hand } from "./SlicesContext";

const HANDS: readonly Hand[] = ["scroll", "greys", "move", "measure"];

/** Function of one finger, slice by slice, grey window, and full view. */
export function SliceTools(): ReactNode {
  const texts = useTexts().plan.slices;
  const { plane, hand, setHand, scroll, setZoom } = useSlices();
  return (
    <div className="slice-tools" role="toolbar" aria-label={texts.tools}>
      <Button
        size="lg"
        variant="default"
        aria-label={texts.back}
        data-testid="slice-back"
        onClick={() => {
          scroll(plane, -1);
        }}
      >
        −
      </Button>
      <Button
        size="lg"
        variant="default"
        aria-label={texts.on}
        data-testid="slice-on"
        onClick={() => {
          scroll(plane, 1);
        }}
      >
        +
      </Button>
      <SegmentedControl
        size="md"
        value={hand}
        aria-label={texts.finger}
        data={HANDS.map((one) => ({ value: one, label: texts.hand[one] }))}
        onChange={setHand}
      />
      <Popover position="top" width={360} withArrow>
        <Popover.Target>
          <Button size="lg" variant="default" data-testid="greys">
            {texts.greys}
          </Button>
        </Popover.Target>
        <Popover.Dropdown>
          <Greys />
        </Popover.Dropdown>
      </Popover>
      <Button
        size="lg"
        variant="default"
        data-testid="whole"
        onClick={() => {
          setZoom(plane, null);
        }}
      >
        {texts.whole}
      </Button>
    </div>
  );
}
