// Directions in which the knobs of a channel lie from its points, so that they never cover each other.
import type { Vec2 } from "../slices/place";

export interface Knobs {
  entry: Vec2;
  whole: Vec2;
  target: Vec2;
}

/** Shorter than this in the picture, the channel counts as seen along its axis. */
const MIN_LENGTH_PX = 2;

/** Before the entry, beyond the target and beside the middle of a channel with these ends in the picture. */
export function knobsOf([ex, ey]: Vec2, [tx, ty]: Vec2): Knobs {
  const [x, y] = [tx - ex, ty - ey];
  if (Math.hypot(x, y) < MIN_LENGTH_PX) return { entry: [-1, 0], whole: [0, -1], target: [1, 0] };
  return { entry: [-x, -y], whole: [-y, x], target: [x, y] };
}

/** The knob of a point; one that would be cut off by the edge of the picture is moved inside of it. */
export function knobAt(
  [x, y]: Vec2,
  towards: Vec2,
  { width, height }: { width: number; height: number },
  { awayPx, radiusPx }: { awayPx: number; radiusPx: number },
): Vec2 {
  const length = Math.hypot(...towards) || 1;
  const at: Vec2 = [x + (towards[0] / length) * awayPx, y + (towards[1] / length) * awayPx];
  const isShown = x >= 0 && y >= 0 && x <= width && y <= height;
  return isShown ? [inside(at[0], radiusPx, width), inside(at[1], radiusPx, height)] : at;
}

function inside(value: number, margin: number, size: number): number {
  return Math.min(size - margin, Math.max(margin, value));
}
