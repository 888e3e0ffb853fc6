// Curve of a figure in pixels of its chart. Pure.
import type { FigureName } from "../panes/limits";
import type { Status } from "../live/messages";
import { MAX_STEP_MS, SPAN_MS, type Sample, type TrendFigure } from "./history";

/** A figure, or the probability that the drill is through a wall, now or 2 mm further, in %. */
export type CurveName = FigureName | "risk";

type Point = readonly [number, number];

interface Stroke {
  status: Status;
  points: Point[];
}

/** A sample that is joined to the next one. */
interface Joint {
  atMs: number;
  figure: TrendFigure;
  at: Point;
}

interface Curve {
  /** Segments of equal status; they do not meet across gaps. */
  strokes: Stroke[];
  /** The limit at each sample. */
  limit: Point[][];
  /** Height of the bone's wall, for the clearance; null for other figures. */
  wallY: number | null;
  /** Values at the lower and upper edge. */
  range: readonly [number, number];
}

/** The smallest and largest range, in multiples of the limit below and above zero. Values beyond it are clamped. */
const RANGES: Record<CurveName, { below: [number, number]; above: [number, number] }> = {
  entry: { below: [0, 0], above: [2, 4] },
  angle: { below: [0, 0], above: [2, 4] },
  depth: { below: [0, 0.5], above: [1.1, 1.4] },
  wall: { below: [1, 3], above: [3, 8] },
  // A probability of 100 % is never clamped.
  risk: { below: [0, 0], above: [2, Infinity] },
};

/** The chart: time of its right edge and its size; samples further apart than `maxStepMs` are not joined. */
interface Frame {
  nowMs: number;
  width: number;
  height: number;
  spanMs?: number;
  maxStepMs?: number;
}

export function curveOf(
  samples: readonly Sample[],
  name: CurveName,
  { nowMs, width, height, spanMs = SPAN_MS, maxStepMs = MAX_STEP_MS }: Frame,
): Curve {
  const range = rangeOf(samples, name);
  const [bottom, top] = range;
  const x = (atMs: number): number => width * (1 - (nowMs - atMs) / spanMs);
  const y = (value: number): number =>
    height * (1 - (Math.min(Math.max(value, bottom), top) - bottom) / (top - bottom));
  const curve: Curve = { strokes: [], limit: [], wallY: name === "wall" ? y(0) : null, range };
  let before: Joint | null = null;
  for (const { atMs, figures } of samples) {
    const figure = figures?.[name];
    if (figure?.value == null) {
      before = null;
      continue;
    }
    const at: Point = [x(atMs), y(figure.value)];
    const joined = atMs - (before?.atMs ?? -Infinity) <= maxStepMs ? before : null;
    const last = curve.strokes.at(-1);
    if (joined === null) curve.strokes.push({ status: figure.status, points: [at] });
    else if (last?.status === figure.status) last.points.push(at);
    // A segment between two statuses has the colour of the later one.
    else curve.strokes.push({ status: figure.status, points: [joined.at, at] });
    if (figure.limit !== null) {
      const limit: Point = [at[0], y(figure.limit)];
      const line = curve.limit.at(-1);
      if (line !== undefined && joined?.figure.limit != null) line.push(limit);
      else curve.limit.push([limit]);
    }
    before = { atMs, figure, at };
  }
  return curve;
}

/** Range around the limit, widened to the values up to a maximum: a distant drill has no trend. */
function rangeOf(samples: readonly Sample[], name: CurveName): readonly [number, number] {
  let [lowest, highest, limit] = [0, 0, 0];
  for (const { figures } of samples) {
    const figure = figures?.[name];
    if (figure?.value == null) continue;
    lowest = Math.min(lowest, figure.value);
    highest = Math.max(highest, figure.value);
    if (figure.limit !== null) limit = Math.max(limit, Math.abs(figure.limit));
  }
  if (limit === 0) return [lowest, Math.max(highest, lowest + 1)];
  const { below, above } = RANGES[name];
  return [
    -Math.min(Math.max(-lowest, below[0] * limit), below[1] * limit),
    Math.min(Math.max(highest, above[0] * limit), above[1] * limit),
  ];
}
