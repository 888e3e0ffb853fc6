/** The next larger or smaller available size; null at the end of the catalogue. */
export function neighbourOf(sizes: readonly number[], now: number, direction: 1 | -1): number | null {
  const beyond = sizes.filter((one) => (one - now) * direction > 1e-9);
  if (beyond.length === 0) return null;
  return direction === 1 ? Math.min(...beyond) : Math.max(...beyond);
}
