// Label of a point on a slice: never cut off, and never over its point.

export const GAP_PX = 10;
/** Smaller pictures have no room even for numbers. */
const NUMBERED_FROM_PX = 220;
const NAMED_FROM_PX = 300;
/** Approximate width of a letter; wider than in most fonts. */
const LETTER_PX = 8.6;

interface Label {
  text: string;
  /** Whether it is to the left of its point. */
  isLeft: boolean;
}

/** Label at `x` in a picture of this width; only its number if the name does not fit, null if neither does. */
export function labelAt(x: number, widthPx: number, number: string, name: string): Label | null {
  if (widthPx < NUMBERED_FROM_PX) return null;
  const isLeft = x > widthPx / 2;
  const room = (isLeft ? x : widthPx - x) - GAP_PX;
  const whole = `${number} ${name}`;
  const fits = name !== "" && widthPx >= NAMED_FROM_PX && whole.length * LETTER_PX <= room;
  return { text: fits ? whole : number, isLeft };
}
