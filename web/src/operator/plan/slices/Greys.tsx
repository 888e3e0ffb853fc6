import { Button, Slider } from "@mantine/core";
import type { ReactNode } from "react";
import { useTexts } from "../../../texts/TextsContext";
import { useSlices } from "./SlicesContext";

/** Window of Hounsfield units: a preset, or two sliders. */
export function Greys(): ReactNode {
  const texts = useTexts().plan.slices;
  const { ct, look, setGreys } = useSlices();
  const { window_hu, level_hu } = look.greys;
  return (
    <div className="greys">
      <div className="greys-presets">
        {Object.entries(ct.presets).map(([name, one]) => (
          <Button
            key={name}
            size="lg"
            variant={one.window_hu === window_hu && one.level_hu === level_hu ? "filled" : "default"}
            aria-pressed={one.window_hu === window_hu && one.level_hu === level_hu}
            onClick={() => {
              setGreys(one);
            }}
          >
            {name in texts.preset ? texts.preset[name as keyof typeof texts.preset] : name}
          </Button>
        ))}
      </div>
      <p id="greys-window">
        {texts.window}: {window_hu} HU
      </p>
      <Slider
        size="xl"
        thumbSize={48}
        min={50}
        max={6000}
        step={10}
        label={null}
        value={window_hu}
        thumbProps={{ "aria-labelledby": "greys-window" }}
        onChange={(value) => {
          setGreys({ window_hu: value, level_hu });
        }}
      />
      <p id="greys-level">
        {texts.level}: {level_hu} HU
      </p>
      <Slider
        size="xl"
        thumbSize={48}
        min={-1000}
        max={3000}
        step={10}
        label={null}
        value={level_hu}
        thumbProps={{ "aria-labelledby": "greys-level" }}
        onChange={(value) => {
          setGreys({ window_hu, level_hu: value });
        }}
      />
    </div>
  );
}
