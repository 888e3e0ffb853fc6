// Marks in the CT: the outline of a mark in the patient, and its part near the plane of a cut. Pure.
import {
  downOf,
  lpsFromPlane,
  normalOf,
  rightOf,
  type PixelGrid,
  type Vec2,
} from "../operator/plan/slices/place";
import { dot, minus, plus, times, vec3, type Vec3 } from "../operator/plan/slices/vectors";
import type { CutPlane, MarkSurface, Moment, Point, Shape } from "../room/messages";

/** A mark is drawn in a cut whose plane passes within this distance, and fainter with it. */
export const MAX_DISTANCE_MM = 2;
/** Opacity in four steps of distance: in each a line is drawn in one piece, so that its pieces do not overlap. */
const STRENGTHS = [1, 0.75, 0.5, 0.3] as const;
/** Distances from the plane at which a step ends, on both sides. */
const STEP_LIMITS_MM = [-4, -3, -2, -1, 1, 2, 3, 4].map(
  (step) => (step * MAX_DISTANCE_MM) / STRENGTHS.length,
);
const CIRCLE_CORNERS = 48;
const MAX_HEAD_MM = 3;

/** Connected part of a mark, in mm of the cut's plane. */
export interface Stroke {
  points: Vec2[];
  strength: number;
}

/** The plane of a cut, as it is sent: rounded, since a message is short. */
export function planeOf(grid: PixelGrid, ctId: string): CutPlane {
  return {
    ct_id: ctId,
    origin_in_vertebra_mm: rounded(lpsFromPlane(grid, [0, 0]), 2),
    right_in_vertebra: rounded(rightOf(grid), 5),
    down_in_vertebra: rounded(downOf(grid), 5),
  };
}

/** What a point in the patient is marked on: the axial plane through it, with the point at (0, 0). */
export function markSurfaceAt(
  point: Vec3,
  ctId: string,
  { image_number, captured_at_s }: Moment,
): MarkSurface {
  const plane: CutPlane = {
    ct_id: ctId,
    origin_in_vertebra_mm: rounded(point, 2),
    right_in_vertebra: [1, 0, 0],
    down_in_vertebra: [0, 1, 0],
  };
  return { image_number, captured_at_s, plane };
}

/** The patient's point at a place of a plane; null if the plane is not three vectors. */
export function patientFrom(plane: CutPlane, [x, y]: Point): Vec3 | null {
  const [origin, right, down] = vectorsOf(plane);
  if (origin == null || right == null || down == null) return null;
  return plus(origin, plus(times(right, x), times(down, y)));
}

/** The place on a plane of the orthogonal projection of a patient's point, to a tenth of a millimetre. */
export function placeOn(plane: CutPlane, point: Vec3): Point | null {
  const [origin, right, down] = vectorsOf(plane);
  if (origin == null || right == null || down == null) return null;
  const away = minus(point, origin);
  return [tenths(dot(away, right)), tenths(dot(away, down))];
}

/** The lines of a mark in the patient. */
export function outlineOf(shape: Shape, points: readonly Point[], plane: CutPlane): Vec3[][] {
  return linesOf(shape, points).map((line) =>
    line.map((one) => patientFrom(plane, one)).filter((one) => one !== null),
  );
}

/** The parts of lines that are near a cut. */
export function strokesOn(grid: PixelGrid, lines: readonly (readonly Vec3[])[]): Stroke[] {
  const place = placingOn(grid);
  return lines.flatMap((line) => strokesOfLine(line.map(place)));
}

/** A point near a cut; null if it is farther away. */
export function pointOn(grid: PixelGrid, point: Vec3): { at: Vec2; strength: number } | null {
  const [x, y, away] = placingOn(grid)(point);
  const strength = strengthAt(away);
  return strength === null ? null : { at: [x, y], strength };
}

/** From a point to x and y in mm on the cut's plane, and its signed distance from it. */
function placingOn(grid: PixelGrid): (point: Vec3) => Vec3 {
  const [origin, right, down, normal] = [
    lpsFromPlane(grid, [0, 0]),
    rightOf(grid),
    downOf(grid),
    normalOf(grid),
  ];
  return (point) => {
    const away = minus(point, origin);
    return [dot(away, right), dot(away, down), dot(away, normal)];
  };
}

/** The near parts of a line of such places; it is divided where its strength changes. */
function strokesOfLine(line: readonly Vec3[]): Stroke[] {
  const strokes: Stroke[] = [];
  // Whether the previous part ended in the last stroke.
  let isConnected = false;
  for (const [index, to] of line.entries()) {
    const from = line[index - 1];
    if (from === undefined && line.length > 1) continue;
    for (const [start, end] of partsOf(from ?? to, to)) {
      const strength = strengthAt((start[2] + end[2]) / 2);
      const last = strokes.at(-1);
      if (strength !== null && isConnected && last?.strength === strength) last.points.push([end[0], end[1]]);
      else if (strength !== null) {
        const at: Vec2 = [start[0], start[1]];
        strokes.push({ points: from === undefined ? [at] : [at, [end[0], end[1]]], strength });
      }
      isConnected = strength !== null;
    }
  }
  return strokes;
}

/** A segment divided where its distance from the plane passes into another step. */
function partsOf(from: Vec3, to: Vec3): [Vec3, Vec3][] {
  const change = to[2] - from[2];
  const shares = STEP_LIMITS_MM.map((limit) => (limit - from[2]) / change).filter(
    (one) => one > 0 && one < 1,
  );
  const places = [
    from,
    ...shares.sort((a, b) => a - b).map((share) => plus(from, times(minus(to, from), share))),
    to,
  ];
  return places.slice(1).map((place, index) => [places[index] ?? from, place]);
}

function strengthAt(distanceMm: number): number | null {
  const step = Math.floor((Math.abs(distanceMm) / MAX_DISTANCE_MM) * STRENGTHS.length);
  return STRENGTHS[step] ?? null;
}

function linesOf(shape: Shape, points: readonly Point[]): Point[][] {
  const [from, to] = points;
  if (shape === "pen" || from === undefined || to === undefined) return [[...points]];
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  const length = Math.hypot(dx, dy);
  if (shape === "circle") {
    const corners = Array.from({ length: CIRCLE_CORNERS + 1 }, (_, index): Point => {
      const angle = (2 * Math.PI * index) / CIRCLE_CORNERS;
      return [from[0] + length * Math.cos(angle), from[1] + length * Math.sin(angle)];
    });
    return [corners];
  }
  const head = Math.min(MAX_HEAD_MM, length / 2);
  const side = (turn: number): Point => {
    const angle = Math.atan2(dy, dx) + turn;
    return [to[0] + head * Math.cos(angle), to[1] + head * Math.sin(angle)];
  };
  return [
    [from, to],
    [side(2.6), to, side(-2.6)],
  ];
}

function vectorsOf(plane: CutPlane): (Vec3 | null)[] {
  return [plane.origin_in_vertebra_mm, plane.right_in_vertebra, plane.down_in_vertebra].map(vec3);
}

function rounded([x, y, z]: Vec3, digits: number): [number, number, number] {
  return [Number(x.toFixed(digits)), Number(y.toFixed(digits)), Number(z.toFixed(digits))];
}

function tenths(value: number): number {
  return Math.round(value * 10) / 10;
}
