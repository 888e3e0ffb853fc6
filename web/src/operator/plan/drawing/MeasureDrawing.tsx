import type { ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import { useTexts } from "../../../texts/TextsContext";
import { angleDeg, lengthsMm, withPoint } from "../slices/measure";
import type { Vec2 } from "../slices/place";
import { pathOf, type Projection } from "../slices/projection";
import { useSlices } from "../slices/SlicesContext";
import { Handle } from "./Handle";
import { besideLeg, insideAngle } from "./measureLabels";

const ON_SLICE_MM = 0.75;
/** On a phone's slice the figures stand in the note alone. */
const LABELLED_FROM_PX = 300;

/** The measurement; fainter and without figures on slices that it does not lie on. */
export function MeasureDrawing({
  projection,
  isLarge,
}: {
  projection: Projection;
  isLarge: boolean;
}): ReactNode {
  const texts = useTexts().plan.slices;
  const { measurement, setMeasurement } = useSlices();
  if (measurement.length === 0) return null;
  const isOn = measurement.every((point) => Math.abs(projection.beyondMm(point)) < ON_SLICE_MM);
  const at = measurement.map((point) => projection.at(point));
  const angle = angleDeg(measurement);
  const hasLabels = isOn && isLarge && projection.stage.width >= LABELLED_FROM_PX;
  return (
    <g className="draw-measure" data-on={isOn || undefined} data-testid="measurement-drawn">
      <path d={pathOf(projection, measurement)} />
      {hasLabels &&
        lengthsMm(measurement).map((mm, i) => {
          const [from, to] = [at[i], at[i + 1]];
          if (from === undefined || to === undefined) return null;
          const third = at.find((_, other) => other !== i && other !== i + 1);
          return (
            <Label
              key={i}
              at={besideLeg(from, to, third, projection.stage)}
              text={`${formatNumber(mm, 1)} mm`}
            />
          );
        })}
      {hasLabels && angle !== null && (
        <Label
          at={insideAngle(...(at as [Vec2, Vec2, Vec2]), projection.stage)}
          text={`${formatNumber(angle, 1)}°`}
        />
      )}
      {isLarge
        ? measurement.map((point, i) => (
            <Handle
              key={i}
              projection={projection}
              name={`measure-${i}`}
              label={`${texts.measure.point} ${i + 1}`}
              point={point}
              towards={awayFrom(
                at[i],
                at.filter((_, other) => other !== i),
              )}
              onMove={(moved) => {
                setMeasurement(withPoint(measurement, i, moved));
              }}
            />
          ))
        : at.map(([x, y], i) => <circle key={i} cx={x} cy={y} r={3} />)}
    </g>
  );
}

function Label({ at: [x, y], text }: { at: Vec2; text: string }): ReactNode {
  return (
    <text x={x} y={y} textAnchor="middle" dominantBaseline="central">
      {text}
    </text>
  );
}

/** Direction in pixels from the middle of other points; to the right without any. */
function awayFrom(point: Vec2 | undefined, others: readonly Vec2[]): Vec2 {
  if (point === undefined || others.length === 0) return [1, 0];
  const sum = others.reduce<Vec2>(([x, y], [dx, dy]) => [x + dx, y + dy], [0, 0]);
  return [point[0] - sum[0] / others.length, point[1] - sum[1] / others.length];
}
