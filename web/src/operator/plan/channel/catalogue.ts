interface Range {
  name: string;
  diameters_mm: readonly number[];
  lengths_mm: readonly number[];
}

/** Names of the product lines that have a screw of this size. */
export function rangesWith(
  ranges: readonly Range[],
  { diameter_mm, length_mm }: { diameter_mm: number; length_mm: number },
): string[] {
  const has = (sizes: readonly number[], size: number): boolean =>
    sizes.some((one) => Math.abs(one - size) < 1e-9);
  return ranges
    .filter((one) => has(one.diameters_mm, diameter_mm) && has(one.lengths_mm, length_mm))
    .map((one) => one.name);
}

/** The next larger or smaller available size; null at the end of the catalogue. */
export function neighbourOf(sizes: readonly number[], now: number, direction: 1 | -1): number | null {
  const beyond = sizes.filter((one) => (one - now) * direction > 1e-9);
  if (beyond.length === 0) return null;
  return direction === 1 ? Math.min(...beyond) : Math.max(...beyond);
}
