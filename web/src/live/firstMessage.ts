// Before its first live message a page is loading: it knows nothing yet, so it claims nothing.

export type FirstMessage = "awaited" | "overdue" | "received";

/** What is known of the first live message since the page was loaded. */
export interface FirstMessageWait {
  everReceived: boolean;
  /** Since when there was no sign of the server: the page's load, its return into view, or an answer. */
  waitingSinceMs: number;
}

/**
 * Without any sign of the server for this long, a page that is still loading says that it is not reached. On a
 * loaded machine the first message takes up to 5 s: twice that raises no false alarm, and who stands before an
 * empty screen for longer needs a hint what to check.
 */
export const REACHED_WITHIN_MS = 10_000;

export function firstMessageAt(
  { everReceived: everHeard, waitingSinceMs }: FirstMessageWait,
  nowMs: number,
): FirstMessage {
  if (everHeard) return "received";
  return nowMs - waitingSinceMs > REACHED_WITHIN_MS ? "overdue" : "awaited";
}
