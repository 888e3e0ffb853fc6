// Position of a patient point in a slice picture.
import type { Px } from "../needles/overlay";

/** `lpsFromPx`: 3 x 3, (u, v, 1) to LPS in mm; its first two columns are orthogonal. */
export function pxInSlice(lpsFromPx: readonly (readonly number[])[], pointMm: readonly number[]): Px {
  const column = (index: number): number[] => [0, 1, 2].map((row) => lpsFromPx[row]?.[index] ?? 0);
  const from = column(2);
  const off = [0, 1, 2].map((axis) => (pointMm[axis] ?? 0) - (from[axis] ?? 0));
  const along = (step: number[]): number => dot(off, step) / dot(step, step);
  return [along(column(0)), along(column(1))];
}

function dot(one: number[], other: number[]): number {
  return one.reduce((sum, value, index) => sum + value * (other[index] ?? 0), 0);
}
