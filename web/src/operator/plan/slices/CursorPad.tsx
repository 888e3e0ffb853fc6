import type { ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import { useTexts } from "../../../texts/TextsContext";
import { ArrowPad } from "./ArrowPad";
import { downOf, rightOf } from "./place";
import { useSlices } from "./SlicesContext";
import { plus, times } from "./vectors";

const STEP_MM = 0.5;

/** Moves the cross by 0.5 mm on the large slice, for what a finger would hide. */
export function CursorPad(): ReactNode {
  const texts = useTexts().plan.cross;
  const { look, goTo, largePlace } = useSlices();
  const move = (right: number, down: number): void => {
    const place = largePlace();
    if (place === null) return;
    const shift = plus(times(rightOf(place), right * STEP_MM), times(downOf(place), down * STEP_MM));
    goTo(plus(look.cursor, shift));
  };
  return (
    <div className="cursor-pad">
      <ArrowPad name="cross" label={texts.title} onMove={move} />
      <p data-testid="cursor">
        {texts.at}
        <br />
        {texts.axes.map((axis, i) => (
          <span key={axis} className="coordinate">
            {axis} {formatNumber(look.cursor[i as 0 | 1 | 2], 1)}
          </span>
        ))}
        <span className="soft">{texts.step}</span>
      </p>
    </div>
  );
}
