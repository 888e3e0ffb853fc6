// Before its first live message a page is loading: it knows nothing and claims nothing.

export type FirstMessage = "awaited" | "overdue" | "received";

/** State of the first live message since the page load. */
export interface FirstMessageWait {
  everReceived: boolean;
  /** Last sign of the server: the page's load, its return into view, or an answer. */
  waitingSinceMs: number;
}

/**
 * After this long without a sign of the server, a loading page states that the server is not reached. On a loaded
 * machine the first message takes up to 5 s; twice that raises no false alarm, and a longer empty screen would leave
 * the user without a hint.
 */
export const REACHED_WITHIN_MS = 10_000;

export function firstMessageAt(
  { everReceived: everHeard, waitingSinceMs }: FirstMessageWait,
  nowMs: number,
): FirstMessage {
  if (everHeard) return "received";
  return nowMs - waitingSinceMs > REACHED_WITHIN_MS ? "overdue" : "awaited";
}
