// What is written beside a point on a slice: never cut off, and never over what it names.

export const GAP_PX = 10;
/** In a smaller picture even numbers lie over one another. */
const NUMBERED_FROM_PX = 220;
const NAMED_FROM_PX = 300;
/** Of a letter, about; wider letters than most fonts have. */
const LETTER_PX = 8.6;

export interface Label {
  text: string;
  /** Whether it stands left of its point. */
  isLeft: boolean;
}

/** At `x` of a picture this wide; without a name its number alone, and null where there is no room at all. */
export function labelAt(x: number, widthPx: number, number: string, name: string): Label | null {
  if (widthPx < NUMBERED_FROM_PX) return null;
  const isLeft = x > widthPx / 2;
  const room = (isLeft ? x : widthPx - x) - GAP_PX;
  const whole = `${number} ${name}`;
  const fits = name !== "" && widthPx >= NAMED_FROM_PX && whole.length * LETTER_PX <= room;
  return { text: fits ? whole : number, isLeft };
}
