// Address of a slice picture on the server, which also identifies it.
import type { CtMessage, WindowMessage } from "../../../api";
import { minus, unit, dot, type Vec3 } from "./vectors";

export type Ct = CtMessage;
type Flat = "axial" | "sagittal" | "coronal";
export type PlaneName = Flat | "along" | "across";
export type Greys = WindowMessage;

export const FLAT: readonly Flat[] = ["axial", "sagittal", "coronal"];
const AXIS: Record<Flat, 0 | 1 | 2> = { sagittal: 0, coronal: 1, axial: 2 };

export const isFlat = (plane: PlaneName): plane is Flat => plane !== "along" && plane !== "across";

/** The line that oblique slices follow. */
export interface Way {
  entry: Vec3;
  target: Vec3;
}

/** What is displayed. */
export interface Look {
  cursor: Vec3;
  greys: Greys;
  way: Way | null;
  /** Angle of the slice along the channel about the drilling direction. */
  turnDeg: number;
  /** Depth of the slice across the channel, from the entry. */
  depthMm: number;
}

const OBLIQUE_PIXEL_MM = 0.4;
const ALONG_MM = { width_mm: 80, height_mm: 110 };
const ACROSS_MM = { width_mm: 50, height_mm: 50 };
const TURN_STEP_DEG = 5;
const DEPTH_STEP_MM = 1;

const short = (value: number): string => String(Math.round(value * 1000) / 1000);
const point = (one: Vec3): string => one.map(short).join(",");

/** Address of a plane's picture; null without a channel to cut along. */
export function addressOf(plane: PlaneName, look: Look, ct: Ct): string | null {
  const query = new URLSearchParams({
    window: short(look.greys.window_hu),
    level: short(look.greys.level_hu),
  });
  // The part after # is not sent; it separates slices of different CTs.
  const of = `#${ct.heading.id}`;
  if (isFlat(plane)) {
    query.set("at_mm", short(placeOf(plane, look, ct)));
    return `/api/ct/slices/${plane}.png?${query.toString()}${of}`;
  }
  if (look.way === null) return null;
  query.set("entry", point(look.way.entry));
  query.set("target", point(look.way.target));
  query.set("view", plane);
  query.set("pixel_mm", String(OBLIQUE_PIXEL_MM));
  const size = plane === "along" ? ALONG_MM : ACROSS_MM;
  for (const [name, value] of Object.entries(size)) query.set(name, String(value));
  if (plane === "along") query.set("rotation_deg", short(look.turnDeg));
  else query.set("depth_mm", short(look.depthMm));
  return `/api/ct/oblique.png?${query.toString()}${of}`;
}

/** Position of a flat slice: the cursor's coordinate, clamped to the CT. */
function placeOf(plane: Flat, look: Look, ct: Ct): number {
  const { from_mm, to_mm } = reachOf(plane, ct);
  return Math.min(to_mm, Math.max(from_mm, look.cursor[AXIS[plane]]));
}

export function reachOf(plane: Flat, ct: Ct): { from_mm: number; to_mm: number; step_mm: number } {
  return ct.planes[plane] ?? { from_mm: 0, to_mm: 0, step_mm: 1 };
}

/** Moves by slices: flat ones by the scanner's spacing, along a channel by angle, across it by depth. */
export function scrolled(plane: PlaneName, look: Look, ct: Ct, steps: number): Look {
  if (steps === 0) return look;
  if (plane === "along") return { ...look, turnDeg: wrapped(look.turnDeg + steps * TURN_STEP_DEG) };
  if (plane === "across") return { ...look, depthMm: within(look.depthMm + steps * DEPTH_STEP_MM, -20, 90) };
  const { from_mm, to_mm, step_mm } = reachOf(plane, ct);
  const index = Math.round((placeOf(plane, look, ct) - from_mm) / step_mm) + steps;
  const at = within(from_mm + index * step_mm, from_mm, to_mm);
  const cursor: [number, number, number] = [...look.cursor];
  cursor[AXIS[plane]] = at;
  return { ...look, cursor };
}

/** Neighbouring slices on both sides, nearest first. */
export function neighboursOf(plane: PlaneName, look: Look, ct: Ct, reach: number): string[] {
  const steps = Array.from({ length: 2 * reach }, (_, i) => (i % 2 === 0 ? 1 : -1) * (Math.floor(i / 2) + 1));
  return steps
    .map((step) => addressOf(plane, scrolled(plane, look, ct, step), ct))
    .filter((one): one is string => one !== null);
}

/** The cursor's depth along the channel. */
export function depthOf(way: Way, cursor: Vec3): number {
  return dot(minus(cursor, way.entry), unit(minus(way.target, way.entry)));
}

function wrapped(angleDeg: number): number {
  return ((((angleDeg + 180) % 360) + 360) % 360) - 180;
}

function within(value: number, low: number, high: number): number {
  return Math.min(high, Math.max(low, value));
}
