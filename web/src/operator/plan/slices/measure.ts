// Measurement by hand on the slices: a distance, or the angle at the second of three points. Never stored.
import { cross, dot, lengthOf, minus, type Vec3 } from "./vectors";

const MAX_POINTS = 3;

/** Up to three points of the patient, in the order of the taps. */
export type Measurement = readonly Vec3[];

/** A further tap; after three points it begins another measurement. */
export function withTap(points: Measurement, point: Vec3): Measurement {
  return points.length >= MAX_POINTS ? [point] : [...points, point];
}

export function withPoint(points: Measurement, index: number, point: Vec3): Measurement {
  return points.map((one, i) => (i === index ? point : one));
}

/** Lengths between successive points. */
export function lengthsMm(points: Measurement): number[] {
  return points.slice(1).map((point, i) => lengthOf(minus(point, points[i] ?? point)));
}

/** Angle at the second of three points, 0 to 180; null without a third or if two are in one place. */
export function angleDeg(points: Measurement): number | null {
  const [from, vertex, to] = points;
  if (from === undefined || vertex === undefined || to === undefined) return null;
  const [one, other] = [minus(from, vertex), minus(to, vertex)];
  if (lengthOf(one) === 0 || lengthOf(other) === 0) return null;
  // Unlike arccos, exact to the last digit also near 0 and 180.
  return (Math.atan2(lengthOf(cross(one, other)), dot(one, other)) * 180) / Math.PI;
}
