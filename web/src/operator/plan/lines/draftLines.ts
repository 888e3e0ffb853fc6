// Preview of the three lines as the server will lay them: vertical on the slice, at a distance.
import type { SliceLine } from "../state/shape";
import type { Vec3 } from "../slices/vectors";

const AHEAD_MM = 50;
const MAX_BEHIND_ENTRY_MM = 60;

/** Middle, left and right line (of the patient) through a point of an axial slice. */
export function draftLines(middle: Vec3, apartMm: number): SliceLine[] {
  const [x, y, z] = middle;
  const shifts = { middle: 0, left: apartMm, right: -apartMm };
  return Object.entries(shifts).map(([name, shift]) => ({
    name,
    ends_lps_mm: [
      [x + shift, y - AHEAD_MM, z],
      [x + shift, y + MAX_BEHIND_ENTRY_MM, z],
    ],
  }));
}

const SAME_MM = 0.05;

/** Whether stored lines equal these. */
export function areSame(lines: readonly SliceLine[], laid: readonly SliceLine[]): boolean {
  return lines.every((line) => {
    const other = laid.find((one) => one.name === line.name);
    return line.ends_lps_mm.every((end, i) =>
      end.every((value, axis) => {
        const there = other?.ends_lps_mm[i as 0 | 1][axis as 0 | 1 | 2];
        return there !== undefined && Math.abs(there - value) < SAME_MM;
      }),
    );
  });
}
