// Whether something on a page can be seen without moving it.

export interface Span {
  top: number;
  bottom: number;
}

/** What is seen through all of these at once. */
export function throughAll(windows: readonly Span[]): Span {
  return {
    top: Math.max(...windows.map((one) => one.top)),
    bottom: Math.min(...windows.map((one) => one.bottom)),
  };
}

/** Whether it stands wholly within what is seen; what is higher than that, when its beginning fills it. */
export function isInSight(box: Span, seen: Span): boolean {
  const fits = box.bottom - box.top <= seen.bottom - seen.top;
  return fits ? box.top >= seen.top && box.bottom <= seen.bottom : Math.abs(box.top - seen.top) < 1;
}
