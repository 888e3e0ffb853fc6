// Parts of a screw by their clearance to the wall.
import type { ClearanceAlongMessage } from "../../../api";

export const LEVELS = ["ample", "low", "breach", "unknown"] as const;
export type Level = (typeof LEVELS)[number];

export interface Part {
  /** Depths from the entry, in mm. */
  from: number;
  to: number;
  level: Level;
}

/** ample: at least the margin; low: less; breach: through the wall. */
export function levelOf(clearanceMm: number, marginMm: number): Level {
  if (clearanceMm < 0) return "breach";
  return clearanceMm < marginMm ? "low" : "ample";
}

/** Parts of one level each, from the entry to the screw's end; each step has the worse level of its two ends. */
export function partsOf(
  along: Pick<ClearanceAlongMessage, "depth_mm" | "clearance_mm"> | null,
  marginMm: number,
  lengthMm: number,
): Part[] {
  const depths = along?.depth_mm ?? [];
  const clearances = along?.clearance_mm ?? [];
  const parts: Part[] = [];
  let at = 0;
  const add = (to: number, level: Level): void => {
    const end = Math.min(to, lengthMm);
    if (end <= at) return;
    const last = parts.at(-1);
    if (last?.level === level) last.to = end;
    else parts.push({ from: at, to: end, level });
    at = end;
  };
  depths.forEach((depth, i) => {
    if (i === 0) add(depth, "unknown");
    else add(depth, levelOf(Math.min(clearances[i - 1] ?? NaN, clearances[i] ?? NaN), marginMm));
  });
  add(lengthMm, "unknown");
  return parts;
}
