// Delay before the next attempt to reach the server.

const FIRST_MS = 100;
/** Upper limit: the theatre must recover within 2 s of the server's return. */
export const LONGEST_WAIT_MS = 500;

/** Delay before attempt `attempt` (0 is the first after a loss). */
export function waitBeforeMs(attempt: number): number {
  return Math.min(FIRST_MS * 2 ** Math.min(attempt, 10), LONGEST_WAIT_MS);
}
