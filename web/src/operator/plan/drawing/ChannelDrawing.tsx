import type { ReactNode } from "react";
import { pathOf, type Projection } from "../slices/projection";
import type { Vec3 } from "../slices/vectors";
import { plus, times, unit, minus } from "../slices/vectors";
import { cylinderOnSlice } from "./cylinder";

interface ChannelDrawingProps {
  projection: Projection;
  entry: Vec3;
  target: Vec3;
  radiusMm: number;
  /** Of the screw, if any. */
  screw?: { diameter_mm: number; length_mm: number } | undefined;
  look: "planned" | "active" | "draft";
}

/** The channel's intersection with this slice, its projected axis, and the screw. */
export function ChannelDrawing(props: ChannelDrawingProps): ReactNode {
  const { projection, entry, target, radiusMm, screw, look } = props;
  const { place } = projection;
  const [x, y] = projection.at(entry);
  const end = screw === undefined ? null : plus(entry, times(unit(minus(target, entry)), screw.length_mm));
  return (
    <g className={`draw-channel draw-${look}`} data-testid={`draw-${look}`}>
      <path
        className="draw-wall"
        d={pathOf(projection, cylinderOnSlice(place, entry, target, radiusMm), { closed: true })}
      />
      {screw !== undefined && end !== null && (
        <path
          className="draw-screw"
          d={pathOf(projection, cylinderOnSlice(place, entry, end, screw.diameter_mm / 2), { closed: true })}
        />
      )}
      <path className="draw-axis" d={pathOf(projection, [entry, target])} />
      <circle className="draw-entry" cx={x} cy={y} r={5} />
    </g>
  );
}
