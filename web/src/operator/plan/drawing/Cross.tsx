import type { ReactNode } from "react";
import type { Projection } from "../slices/projection";
import type { Vec3 } from "../slices/vectors";

const GAP_PX = 12;

/** The common point of all planes, open in the middle so that it does not hide the target. */
export function Cross({ projection, cursor }: { projection: Projection; cursor: Vec3 }): ReactNode {
  const [x, y] = projection.at(cursor);
  const { width, height } = projection.stage;
  return (
    <g className="draw-cross" data-testid="cross">
      <path
        d={`M 0 ${y} H ${x - GAP_PX} M ${x + GAP_PX} ${y} H ${width} M ${x} 0 V ${y - GAP_PX} M ${x} ${y + GAP_PX} V ${height}`}
      />
      <circle cx={x} cy={y} r={1.5} />
    </g>
  );
}
