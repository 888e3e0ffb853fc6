// Whether an element is visible without scrolling.

export interface Span {
  top: number;
  bottom: number;
}

/** Intersection of these areas. */
export function throughAll(windows: readonly Span[]): Span {
  return {
    top: Math.max(...windows.map((one) => one.top)),
    bottom: Math.min(...windows.map((one) => one.bottom)),
  };
}

/** Whether an element is completely visible; a taller one, whether it fills the area from its top. */
export function isInSight(box: Span, seen: Span): boolean {
  const fits = box.bottom - box.top <= seen.bottom - seen.top;
  return fits ? box.top >= seen.top && box.bottom <= seen.bottom : Math.abs(box.top - seen.top) < 1;
}
