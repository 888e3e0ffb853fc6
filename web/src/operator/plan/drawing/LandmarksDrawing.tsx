import type { ReactNode } from "react";
import type { Projection } from "../slices/projection";
import type { Landmark } from "../state/shape";
import { GAP_PX, labelAt } from "./label";

const ON_SLICE_MM = 1.5;
const NEAR_MM = 12;

/** Landmarks: filled and labelled on their own slice, hollow near it. */
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
        const isOn = away <= ON_SLICE_MM;
        const label = labelAt(x, width, String(index + 1), isOn ? name : "");
        return (
          <g key={name} data-on={isOn || undefined}>
            <circle cx={x} cy={y} r={isOn ? 6 : 4} />
            {label !== null && (
              <text
                x={label.isLeft ? x - GAP_PX : x + GAP_PX}
                y={y + 5}
                textAnchor={label.isLeft ? "end" : "start"}
              >
                {label.text}
              </text>
            )}
          </g>
        );
      })}
    </g>
  );
}
