import type { ReactNode } from "react";
import type { Projection } from "../slices/projection";
import type { Landmark } from "../state/shape";

const ON_SLICE_MM = 1.5;
const NEAR_MM = 12;
/** In a small picture names would cover what they name. */
const NAMED_FROM_PX = 300;

/** The landmarks: full and named on their own slice, hollow near it. */
export function LandmarksDrawing({
  projection,
  landmarks,
}: {
  projection: Projection;
  landmarks: readonly Landmark[];
}): ReactNode {
  const { width } = projection.stage;
  return (
    <g className="draw-landmarks">
      {landmarks.map(({ name, point_lps_mm }, index) => {
        const away = Math.abs(projection.beyondMm(point_lps_mm));
        if (away > NEAR_MM) return null;
        const [x, y] = projection.at(point_lps_mm);
        const isRight = x > 0.55 * width;
        const isOn = away <= ON_SLICE_MM;
        return (
          <g key={name} data-on={isOn || undefined}>
            <circle cx={x} cy={y} r={isOn ? 6 : 4} />
            <text x={isRight ? x - 10 : x + 10} y={y + 5} textAnchor={isRight ? "end" : "start"}>
              {isOn && width > NAMED_FROM_PX ? `${index + 1} ${name}` : index + 1}
            </text>
          </g>
        );
      })}
    </g>
  );
}
