import type { ReactNode } from "react";
import { pathOf, type Projection } from "../slices/projection";
import type { Pedicle } from "../state/shape";

/** Distance from the slice up to which the narrowest section is still drawn, fainter. */
const NEAR_MM = 8;

/** Measured wall of the narrowest section, and the pedicle's axis from arch to front. */
export function PedicleDrawing({
  projection,
  pedicle,
}: {
  projection: Projection;
  pedicle: Pedicle;
}): ReactNode {
  const away = Math.abs(projection.beyondMm(pedicle.isthmus_lps_mm));
  const [x, y] = projection.at(pedicle.isthmus_lps_mm);
  return (
    <g className="draw-pedicle" data-testid={`draw-pedicle-${pedicle.side}`}>
      <path className="draw-axis" d={pathOf(projection, [pedicle.entry_lps_mm, pedicle.front_lps_mm])} />
      {away <= NEAR_MM && (
        <>
          <path
            className="draw-wall"
            d={pathOf(projection, pedicle.outline_lps_mm, { closed: true })}
            opacity={away < 1.5 ? 1 : 0.5}
          />
          <circle cx={x} cy={y} r={3} />
        </>
      )}
    </g>
  );
}
