// What the bull's-eye is drawn from, in mm: right and up from the channel's axis. Pure. The burned-in one in the
// video (server/overlay/bullseye.py) goes by the same rules.
import type { BullseyeMessage } from "../live/messages";

export type Point = readonly [number, number];

const POINTS = 48;
const TOWARDS = 0.13;
const TIP_OF_ARROW = 0.78;

export interface BullseyeGeometry {
  /** Where the tip is, and the drill's ring around it; null where that is beyond the border. */
  tip: Point | null;
  /** At the border, towards a tip beyond it. */
  arrow: readonly Point[] | null;
  /** From where the drill came in to where it would end, held within the border. */
  way: readonly [Point, Point] | null;
  /** Where it would end, if that is within the border. */
  end: Point | null;
  /** Holds the tip with 95 in 100. */
  ellipse: readonly Point[] | null;
  /** The place of the drill that is nearest to a wall, if that is within the border. */
  nearest: Point | null;
}

export function bullseyeGeometry(along: BullseyeMessage): BullseyeGeometry {
  const reach = along.reach_mm;
  const tip = place(along.tip_mm) ?? [0, 0];
  if (Math.hypot(...tip) > reach) {
    return { tip: null, arrow: arrowTo(tip, reach), way: null, end: null, ellipse: null, nearest: null };
  }
  const entry = place(along.at_entry_mm);
  const target = place(along.at_target_mm);
  return {
    tip,
    arrow: null,
    way: [clampToReach(entry, tip, reach), clampToReach(target, tip, reach)],
    end: target !== null && Math.hypot(...target) <= reach ? target : null,
    ellipse: along.tip_half_axes_95_mm === null ? null : ellipseAt(tip, along.tip_half_axes_95_mm, reach),
    nearest: within(place(along.nearest_mm), reach),
  };
}

/** A place held within reach, along its line from the tip; the tip itself where there is none. */
export function clampToReach(at: Point | null, tip: Point, reach: number): Point {
  if (at === null) return tip;
  const [x, y] = [at[0] - tip[0], at[1] - tip[1]];
  const a = x * x + y * y;
  if (a < 1e-12) return at;
  const b = x * tip[0] + y * tip[1];
  const c = tip[0] ** 2 + tip[1] ** 2 - reach ** 2;
  const farthest = (-b + Math.sqrt(Math.max(b * b - a * c, 0))) / a;
  const share = Math.min(1, farthest);
  return [tip[0] + share * x, tip[1] + share * y];
}

function ellipseAt(tip: Point, halfAxes: readonly number[][], reach: number): Point[] {
  const [first, second] = halfAxes.map((axis) => place(axis) ?? [0, 0]);
  if (first === undefined || second === undefined) return [];
  return Array.from({ length: POINTS }, (_, index) => {
    const turn = (2 * Math.PI * index) / POINTS;
    const [c, s] = [Math.cos(turn), Math.sin(turn)];
    const at: Point = [tip[0] + c * first[0] + s * second[0], tip[1] + c * first[1] + s * second[1]];
    // What lies beyond the border stands on it.
    const inwards = Math.min(1, reach / Math.max(Math.hypot(...at), 1e-9));
    return [at[0] * inwards, at[1] * inwards];
  });
}

function arrowTo(tip: Point, reach: number): Point[] {
  const away = Math.hypot(...tip);
  const [x, y] = [tip[0] / away, tip[1] / away];
  const across = TOWARDS * reach;
  const back = TIP_OF_ARROW * reach;
  return [
    [back * x - across * y, back * y + across * x],
    [reach * x, reach * y],
    [back * x + across * y, back * y - across * x],
  ];
}

function within(at: Point | null, reach: number): Point | null {
  return at !== null && Math.hypot(...at) <= reach ? at : null;
}

function place(at: readonly number[] | null): Point | null {
  const [x, y] = at ?? [];
  return x === undefined || y === undefined ? null : [x, y];
}
