import type { ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import { useTexts } from "../../../texts/TextsContext";
import { angleDeg, lengthsMm, withPoint } from "../slices/measure";
import type { Vec2 } from "../slices/place";
import { pathOf, type Projection } from "../slices/projection";
import { useSlices } from "../slices/SlicesContext";
import { Handle } from "./Handle";

const ON_SLICE_MM = 0.75;
const LABEL_AWAY_PX = 14;
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
  const vertex = at[1];
  const hasLabels = isOn && isLarge && projection.stage.width >= LABELLED_FROM_PX;
  return (
    <g className="draw-measure" data-on={isOn || undefined} data-testid="measurement-drawn">
      <path d={pathOf(projection, measurement)} />
      {hasLabels &&
        lengthsMm(measurement).map((mm, i) => (
          <Label
            key={i}
            at={meanOf([at[i], at[i + 1]])}
            widthPx={projection.stage.width}
            text={`${formatNumber(mm, 1)} mm`}
          />
        ))}
      {hasLabels && angle !== null && vertex !== undefined && (
        <Label at={vertex} widthPx={projection.stage.width} text={`${formatNumber(angle, 1)}°`} />
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

/** A figure beside its point, towards the middle of the picture. */
function Label({ at: [x, y], widthPx, text }: { at: Vec2; widthPx: number; text: string }): ReactNode {
  const isLeft = x > widthPx / 2;
  return (
    <text
      x={isLeft ? x - LABEL_AWAY_PX : x + LABEL_AWAY_PX}
      y={y + LABEL_AWAY_PX}
      textAnchor={isLeft ? "end" : "start"}
    >
      {text}
    </text>
  );
}

function meanOf(points: readonly (Vec2 | undefined)[]): Vec2 {
  const there = points.filter((one) => one !== undefined);
  const sum = there.reduce<Vec2>(([x, y], [dx, dy]) => [x + dx, y + dy], [0, 0]);
  return [sum[0] / there.length, sum[1] / there.length];
}

/** Direction in pixels from other points; to the right without any. */
function awayFrom(point: Vec2 | undefined, others: readonly Vec2[]): Vec2 {
  if (point === undefined || others.length === 0) return [1, 0];
  const [x, y] = meanOf(others);
  return [point[0] - x, point[1] - y];
}
