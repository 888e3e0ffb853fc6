import type { ReactNode } from "react";
import { pathOf, type Projection } from "../slices/projection";
import type { SliceLine } from "../state/shape";

const ON_SLICE_MM = 0.75;

/** The three lines and the channels of the reference slice, on that slice only. */
export function LinesDrawing({
  projection,
  lines,
  isDraft = false,
}: {
  projection: Projection;
  lines: readonly SliceLine[];
  isDraft?: boolean;
}): ReactNode {
  return (
    <g className={isDraft ? "draw-lines draw-lines-draft" : "draw-lines"}>
      {lines
        .filter((line) => line.ends_lps_mm.every((end) => Math.abs(projection.beyondMm(end)) < ON_SLICE_MM))
        .map((line) => (
          <path key={line.name} data-line={line.name} d={pathOf(projection, line.ends_lps_mm)} />
        ))}
    </g>
  );
}
