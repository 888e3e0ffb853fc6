// Places of a measurement's figures in the picture: beside its legs, outside of the angle, and the angle inside.
import type { Vec2 } from "../slices/place";
import type { Stage } from "../slices/zoom";

/** Half of a figure with its unit, as drawn. */
export const HALF_TEXT: Vec2 = [44, 10];
const GAP_PX = 8;
const ANGLE_AWAY_PX = 40;
/** Farther than half of a figure, so that none is cut off. */
const EDGE: Vec2 = [HALF_TEXT[0] + 2, HALF_TEXT[1] + 2];

const minus = ([ax, ay]: Vec2, [bx, by]: Vec2): Vec2 => [ax - bx, ay - by];
const dot = ([ax, ay]: Vec2, [bx, by]: Vec2): number => ax * bx + ay * by;

function unit([x, y]: Vec2): Vec2 {
  const length = Math.hypot(x, y);
  return length === 0 ? [0, 0] : [x / length, y / length];
}

/** Centre of the figure of a leg, on the side away from the third point. */
export function besideLeg(from: Vec2, to: Vec2, third: Vec2 | undefined, stage: Stage): Vec2 {
  const middle: Vec2 = [(from[0] + to[0]) / 2, (from[1] + to[1]) / 2];
  const [dx, dy] = unit(minus(to, from));
  const aside: Vec2 = [dy, -dx];
  const sign = third !== undefined && dot(aside, minus(third, middle)) > 0 ? -1 : 1;
  // Half of the text reaches this far along the normal.
  const away = GAP_PX + HALF_TEXT[0] * Math.abs(aside[0]) + HALF_TEXT[1] * Math.abs(aside[1]);
  return within([middle[0] + sign * aside[0] * away, middle[1] + sign * aside[1] * away], stage);
}

/** Centre of the figure of the angle at the vertex, on its bisector. */
export function insideAngle(from: Vec2, vertex: Vec2, to: Vec2, stage: Stage): Vec2 {
  const [one, other] = [unit(minus(from, vertex)), unit(minus(to, vertex))];
  const bisector = unit([one[0] + other[0], one[1] + other[1]]);
  return within([vertex[0] + bisector[0] * ANGLE_AWAY_PX, vertex[1] + bisector[1] * ANGLE_AWAY_PX], stage);
}

function within([x, y]: Vec2, { width, height }: Stage): Vec2 {
  return [Math.min(width - EDGE[0], Math.max(EDGE[0], x)), Math.min(height - EDGE[1], Math.max(EDGE[1], y))];
}
