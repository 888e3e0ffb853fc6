// When the check is asked for again.

/** Minutes until then, at least 0; null where no check says how old it is. */
export function minutesLeft(ageMin: unknown, againAfterMin: number): number | null {
  return typeof ageMin === "number" ? Math.max(0, againAfterMin - ageMin) : null;
}
