// Planes of the cuts: position of their pixels in the patient (LPS, mm). As on the plan page (tracker/plan/slices), the
// drilling direction points up in the in-line cuts, the probe's eye looks along the drill with the feet down, and the
// anatomical cuts through the tip have the radiological convention.
import type { PixelGrid } from "../operator/plan/slices/place";
import { cross, dot, lengthOf, minus, plus, times, unit, type Vec3 } from "../operator/plan/slices/vectors";

export const IN_LINE = ["axial", "sagittal"] as const;
export const ANATOMICAL = ["anatomical-axial", "anatomical-sagittal", "anatomical-coronal"] as const;
type InLine = (typeof IN_LINE)[number];
type Anatomical = (typeof ANATOMICAL)[number];
export type CutName = InLine | Anatomical | "probe";

/** A drill, or the plan in its place: tip and unit drilling direction in the vertebra frame. */
export interface Pose {
  tip: Vec3;
  axis: Vec3;
}

/** Field of a stage, in mm. */
interface Field {
  widthMm: number;
  heightMm: number;
}

const PIXEL_MM = 0.25;
/** Shorter side of the field, and the maximum of the longer one. */
const SHORT_SIDE_MM = { plane: 64, probe: 44 };
const MAX_SIDE_MM = 110;
/** In an in-line cut the tip is this share of the height below the middle, to show more of what is ahead. */
const TIP_BELOW = 0.12;
/** A direction nearer than this to the axis cannot define "up". */
const MIN_ACROSS = 0.1;

const LEFT: Vec3 = [1, 0, 0];
const BACK: Vec3 = [0, 1, 0];
const HEAD: Vec3 = [0, 0, 1];
const FEET: Vec3 = [0, 0, -1];

/** Axial seen from the feet, sagittal from the patient's left, coronal from the front. */
const VIEWS: Record<Anatomical, { right: Vec3; down: Vec3 }> = {
  "anatomical-axial": { right: LEFT, down: BACK },
  "anatomical-sagittal": { right: BACK, down: FEET },
  "anatomical-coronal": { right: LEFT, down: FEET },
};

export function isAnatomical(name: CutName): name is Anatomical {
  return name in VIEWS;
}

/** Undistorted field of a stage with this many page pixels. */
export function fieldOf(name: CutName, widthPx: number, heightPx: number): Field {
  const short = SHORT_SIDE_MM[name === "probe" ? "probe" : "plane"];
  const perPx = Math.min(short / Math.min(widthPx, heightPx), MAX_SIDE_MM / Math.max(widthPx, heightPx));
  return { widthMm: widthPx * perPx, heightMm: heightPx * perPx };
}

/** The plane of a cut through a pose; for the probe's eye this far ahead of the tip. */
export function cutGrid(name: CutName, { tip, axis }: Pose, field: Field, aheadMm: number): PixelGrid {
  if (name === "probe") {
    const down = across(axis, FEET, BACK);
    return grid(plus(tip, times(axis, aheadMm)), cross(down, axis), down, field);
  }
  if (isAnatomical(name)) {
    const { right, down } = VIEWS[name];
    return grid(tip, right, down, field);
  }
  const leftwards = across(axis, LEFT, HEAD);
  // Rotated about the drilling direction by the right-hand rule, as on the plan page.
  const right = name === "axial" ? leftwards : cross(axis, leftwards);
  return grid(plus(tip, times(axis, TIP_BELOW * field.heightMm)), right, times(axis, -1), field);
}

function grid(centre: Vec3, right: Vec3, down: Vec3, { widthMm, heightMm }: Field): PixelGrid {
  const [width_px, height_px] = [Math.round(widthMm / PIXEL_MM), Math.round(heightMm / PIXEL_MM)];
  const toCorner = plus(
    times(right, (-(width_px - 1) / 2) * PIXEL_MM),
    times(down, (-(height_px - 1) / 2) * PIXEL_MM),
  );
  const [u, v, start] = [times(right, PIXEL_MM), times(down, PIXEL_MM), plus(centre, toCorner)];
  const lps_from_px = [0, 1, 2].map((axis) => [u[axis] ?? 0, v[axis] ?? 0, start[axis] ?? 0]);
  return { lps_from_px, pixel_mm: [PIXEL_MM, PIXEL_MM], width_px, height_px };
}

/** The unit direction perpendicular to the axis that is nearest to the wanted one. */
function across(axis: Vec3, wanted: Vec3, otherwise: Vec3): Vec3 {
  const part = (direction: Vec3): Vec3 => minus(direction, times(axis, dot(direction, axis)));
  const first = part(wanted);
  return unit(lengthOf(first) > MIN_ACROSS ? first : part(otherwise));
}

/** Directions of the three LPS axes, positive and negative. */
const LETTERS = ["LR", "PA", "HF"] as const;
const WITHIN = Math.cos(Math.PI / 4);

/** The patient's direction within 45 degrees of this one; empty if there is none. */
export function directionLetter(direction: Vec3): string {
  const index = direction.findIndex((part) => Math.abs(part) >= WITHIN);
  return LETTERS[index]?.[(direction[index] ?? 0) > 0 ? 0 : 1] ?? "";
}
