// A channel that is being moved by hand and is not saved yet.
import { dot, lengthOf, minus, plus, times, turned, unit, type Vec3 } from "../slices/vectors";
import type { Channel } from "../state/shape";

export interface Draft {
  entry: Vec3;
  target: Vec3;
  diameterMm: number;
}

export const MAX_DIAMETER_MM = 20;
export const MIN_DIAMETER_MM = 1;
const MIN_LENGTH_MM = 1;

export function draftOf(channel: Channel): Draft {
  return {
    entry: channel.entry_in_vertebra_mm,
    target: channel.target_in_vertebra_mm,
    diameterMm: 2 * channel.radius_mm,
  };
}

export function isSame(draft: Draft, channel: Channel): boolean {
  const off = Math.max(
    lengthOf(minus(draft.entry, channel.entry_in_vertebra_mm)),
    lengthOf(minus(draft.target, channel.target_in_vertebra_mm)),
    Math.abs(draft.diameterMm - 2 * channel.radius_mm),
  );
  return off < 1e-6;
}

export const MOVED = ["whole", "entry", "target"] as const;
export type Moved = (typeof MOVED)[number];

/** Unchanged if its ends would come together. */
export function shiftChannel(draft: Draft, what: Moved, by: Vec3): Draft {
  const shifted = {
    ...draft,
    entry: what === "target" ? draft.entry : plus(draft.entry, by),
    target: what === "entry" ? draft.target : plus(draft.target, by),
  };
  return lengthMm(shifted) < MIN_LENGTH_MM ? draft : shifted;
}

export function middleOf(draft: Draft): Vec3 {
  return times(plus(draft.entry, draft.target), 0.5);
}

/** With its entry, its end, or the middle of all of it at this point. */
export function placeChannel(draft: Draft, what: Moved, point: Vec3): Draft {
  const now = what === "whole" ? middleOf(draft) : draft[what];
  return shiftChannel(draft, what, minus(point, now));
}

/** Rotated about its entry in the plane of a slice; positive is clockwise for the viewer. */
export function rotateChannel(draft: Draft, normal: Vec3, angleDeg: number): Draft {
  return { ...draft, target: plus(draft.entry, turned(minus(draft.target, draft.entry), normal, angleDeg)) };
}

/** Lengthened at its end. */
export function extendChannel(draft: Draft, byMm: number): Draft {
  const length = lengthMm(draft);
  return {
    ...draft,
    target: plus(draft.entry, times(axisOf(draft), Math.max(MIN_LENGTH_MM, length + byMm))),
  };
}

export function lengthMm(draft: Draft): number {
  return lengthOf(minus(draft.target, draft.entry));
}

function axisOf(draft: Draft): Vec3 {
  return unit(minus(draft.target, draft.entry));
}

/** Angles as on an axial and a sagittal slice, from straight forward; medial and cranial are positive. */
export function anglesOf(
  draft: Draft,
  side: "left" | "right",
): { transverseDeg: number; sagittalDeg: number } {
  const axis = axisOf(draft);
  const medial = side === "left" ? -axis[0] : axis[0];
  return {
    transverseDeg: (Math.atan2(medial, -axis[1]) * 180) / Math.PI,
    sagittalDeg: (Math.atan2(axis[2], -axis[1]) * 180) / Math.PI,
  };
}

/** Distance of a point from the axis. */
export function besideMm(draft: Draft, point: Vec3): number {
  const away = minus(point, draft.entry);
  return lengthOf(minus(away, times(axisOf(draft), dot(away, axisOf(draft)))));
}
