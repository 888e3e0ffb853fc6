// Which picture shows what is looked at: its address at the server is what it is known by.
import type { components } from "../../../schema";
import { minus, unit, dot, type Vec3 } from "./vectors";

export type Ct = components["schemas"]["CtMessage"];
export type Flat = "axial" | "sagittal" | "coronal";
export type PlaneName = Flat | "along" | "across";
export type Greys = components["schemas"]["WindowMessage"];

export const FLAT: readonly Flat[] = ["axial", "sagittal", "coronal"];
export const AXIS: Record<Flat, 0 | 1 | 2> = { sagittal: 0, coronal: 1, axial: 2 };

export const isFlat = (plane: PlaneName): plane is Flat => plane !== "along" && plane !== "across";

/** The line that the oblique slices are cut along and across. */
export interface Way {
  entry: Vec3;
  target: Vec3;
}

/** What is looked at. */
export interface Look {
  cursor: Vec3;
  greys: Greys;
  way: Way | null;
  /** Of the slice along the channel, about the drilling direction. */
  turnDeg: number;
  /** Of the slice across it, from the entry. */
  depthMm: number;
}

const OBLIQUE_PIXEL_MM = 0.4;
const ALONG_MM = { width_mm: 80, height_mm: 110 };
const ACROSS_MM = { width_mm: 50, height_mm: 50 };
const TURN_STEP_DEG = 5;
const DEPTH_STEP_MM = 1;

const short = (value: number): string => String(Math.round(value * 1000) / 1000);
const point = (one: Vec3): string => one.map(short).join(",");

/** The address of a plane's picture; null where there is no channel to cut along. */
export function addressOf(plane: PlaneName, look: Look, ct: Ct): string | null {
  const query = new URLSearchParams({
    window: short(look.greys.window_hu),
    level: short(look.greys.level_hu),
  });
  // What stands behind # is not sent; it keeps apart what was cut from another CT.
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

/** Where a flat slice lies: the cursor's coordinate, held within the CT. */
function placeOf(plane: Flat, look: Look, ct: Ct): number {
  const { from_mm, to_mm } = reachOf(plane, ct);
  return Math.min(to_mm, Math.max(from_mm, look.cursor[AXIS[plane]]));
}

export function reachOf(plane: Flat, ct: Ct): { from_mm: number; to_mm: number; step_mm: number } {
  return ct.planes[plane] ?? { from_mm: 0, to_mm: 0, step_mm: 1 };
}

/** So many slices further: flat ones by the scanner's own steps, along a channel by turning, across by depth. */
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

/** Slices on both sides, the nearest first. */
export function neighboursOf(plane: PlaneName, look: Look, ct: Ct, reach: number): string[] {
  const steps = Array.from({ length: 2 * reach }, (_, i) => (i % 2 === 0 ? 1 : -1) * (Math.floor(i / 2) + 1));
  return steps
    .map((step) => addressOf(plane, scrolled(plane, look, ct, step), ct))
    .filter((one): one is string => one !== null);
}

/** The cursor as a depth along the way: where the slice across it passes through the cursor. */
export function depthOf(way: Way, cursor: Vec3): number {
  return dot(minus(cursor, way.entry), unit(minus(way.target, way.entry)));
}

function wrapped(angleDeg: number): number {
  return ((((angleDeg + 180) % 360) + 360) % 360) - 180;
}

function within(value: number, low: number, high: number): number {
  return Math.min(high, Math.max(low, value));
}
