import type { ReactNode } from "react";
import { pathOf, type Projection } from "../slices/projection";
import type { Vec3 } from "../slices/vectors";
import { plus, times, unit, minus } from "../slices/vectors";
import type { Part } from "./clearance";
import { cylinderOnSlice } from "./cylinder";

interface ChannelDrawingProps {
  projection: Projection;
  entry: Vec3;
  target: Vec3;
  radiusMm: number;
  /** The screw, if any, in parts by its clearance. */
  screw?: { diameter_mm: number; parts: readonly Part[] } | undefined;
  look: "planned" | "active" | "draft";
}

/** The channel's intersection with this slice, its projected axis, and the screw by its clearance. */
export function ChannelDrawing(props: ChannelDrawingProps): ReactNode {
  const { projection, entry, target, radiusMm, screw, look } = props;
  const { place } = projection;
  const [x, y] = projection.at(entry);
  const axis = unit(minus(target, entry));
  const depth = (mm: number): Vec3 => plus(entry, times(axis, mm));
  return (
    <g className={`draw-channel draw-${look}`} data-testid={`draw-${look}`}>
      <path
        className="draw-wall"
        d={pathOf(projection, cylinderOnSlice(place, entry, target, radiusMm), { closed: true })}
      />
      <path className="draw-axis" d={pathOf(projection, [entry, target])} />
      {screw?.parts.map(({ from, to, level }) => (
        <g key={from} className="draw-screw" data-clearance={level}>
          <path
            d={pathOf(projection, cylinderOnSlice(place, depth(from), depth(to), screw.diameter_mm / 2), {
              closed: true,
            })}
          />
          {level !== "unknown" && (
            <path className="draw-axis" d={pathOf(projection, [depth(from), depth(to)])} />
          )}
        </g>
      ))}
      <circle className="draw-entry" cx={x} cy={y} r={5} />
    </g>
  );
}
