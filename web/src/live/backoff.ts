// How long to wait before the next attempt to reach the server.

const FIRST_MS = 100;
/** The theatre must be right again within 2 s of the server's return: never wait longer than this. */
export const LONGEST_WAIT_MS = 500;

/** Wait before attempt number `attempt` (0 is the first after a loss). */
export function waitBeforeMs(attempt: number): number {
  return Math.min(FIRST_MS * 2 ** Math.min(attempt, 10), LONGEST_WAIT_MS);
}
