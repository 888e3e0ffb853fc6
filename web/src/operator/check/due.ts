// Time until the next check.

/** Minutes until the check is due, at least 0; null without a check of known age. */
export function minutesLeft(ageMin: unknown, againAfterMin: number): number | null {
  return typeof ageMin === "number" ? Math.max(0, againAfterMin - ageMin) : null;
}
