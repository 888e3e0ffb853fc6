// Position of a slice's pixels in the patient, as sent with the picture.
//
// Three coordinates of one point: LPS in mm; (u, v) in pixels, with (0, 0) at the centre of the top-left pixel; and
// (x, y) in mm on the slice's plane (u and v times the spacing of columns and rows), in which drawings are made.
import type { SliceMessage } from "../../../api";
import { cross, dot, minus, plus, times, unit, type Vec3 } from "./vectors";

export type Place = SliceMessage;
/** Placement of a picture's pixels: all that drawing needs. */
export type PixelGrid = Pick<Place, "lps_from_px" | "pixel_mm" | "width_px" | "height_px">;
export type Vec2 = readonly [number, number];

function column(place: PixelGrid, index: number): Vec3 {
  const [x, y, z] = place.lps_from_px.map((row) => row[index] ?? 0);
  return [x ?? 0, y ?? 0, z ?? 0];
}

export function lpsFromPx(place: PixelGrid, [u, v]: Vec2): Vec3 {
  return plus(column(place, 2), plus(times(column(place, 0), u), times(column(place, 1), v)));
}

/** Pixel of the orthogonal projection of a point onto the slice. */
export function pxFromLps(place: PixelGrid, point: Vec3): Vec2 {
  const [right, down] = [column(place, 0), column(place, 1)];
  const away = minus(point, column(place, 2));
  // With a tilted gantry the columns need not be perpendicular to the rows.
  const [rr, rd, dd] = [dot(right, right), dot(right, down), dot(down, down)];
  const [r, d] = [dot(right, away), dot(down, away)];
  const determinant = rr * dd - rd * rd;
  return [(dd * r - rd * d) / determinant, (rr * d - rd * r) / determinant];
}

const pitch = (place: PixelGrid): Vec2 => [place.pixel_mm[0] ?? 1, place.pixel_mm[1] ?? 1];

export function planeFromLps(place: PixelGrid, point: Vec3): Vec2 {
  const [u, v] = pxFromLps(place, point);
  const [across, along] = pitch(place);
  return [u * across, v * along];
}

export function lpsFromPlane(place: PixelGrid, [x, y]: Vec2): Vec3 {
  const [across, along] = pitch(place);
  return lpsFromPx(place, [x / across, y / along]);
}

/** Signed distance of a point from the slice; positive is behind it for the viewer. */
export function beyondMm(place: PixelGrid, point: Vec3): number {
  return dot(minus(point, column(place, 2)), normalOf(place));
}

export function normalOf(place: PixelGrid): Vec3 {
  return unit(cross(column(place, 0), column(place, 1)));
}

/** Unit directions right and down in the picture. */
export function rightOf(place: PixelGrid): Vec3 {
  return unit(column(place, 0));
}

export function downOf(place: PixelGrid): Vec3 {
  return unit(column(place, 1));
}

/** Bounds of the picture on its plane, from the outer edges of its pixels. */
export function frameOf(place: PixelGrid): { x: number; y: number; width: number; height: number } {
  const [across, along] = pitch(place);
  return {
    x: -across / 2,
    y: -along / 2,
    width: place.width_px * across,
    height: place.height_px * along,
  };
}

/** Part of a segment within this distance of the slice; null if none. */
export function nearPart(
  place: PixelGrid,
  from: Vec3,
  to: Vec3,
  withinMm: number,
): readonly [Vec3, Vec3] | null {
  const [a, b] = [beyondMm(place, from), beyondMm(place, to)];
  const step = b - a;
  if (Math.abs(step) < 1e-9) return Math.abs(a) <= withinMm ? [from, to] : null;
  const ends = [(-withinMm - a) / step, (withinMm - a) / step];
  const start = Math.max(0, Math.min(...ends));
  const end = Math.min(1, Math.max(...ends));
  if (start > end) return null;
  const way = minus(to, from);
  return [plus(from, times(way, start)), plus(from, times(way, end))];
}
