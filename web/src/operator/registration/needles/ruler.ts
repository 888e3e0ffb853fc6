// Camera position measured with a ruler beside the table, and its storage.
import type { ViewMessage } from "../../../api";

export type RuledView = ViewMessage;

export const FIRST_VIEW: RuledView = {
  vertical_mm: 400,
  horizontal_mm: 250,
  azimuth_deg: 0,
  patient_end: "feet",
  ruler_sd_mm: 10,
  azimuth_sd_deg: 5,
  roll_sd_deg: 3,
  prone_sd_deg: 5,
};

/** Simulated ruler of the rehearsal, for a vertebra that lies flat. */
export function viewOfTruth(
  cameraFromVertebra: readonly (readonly number[])[],
  middleMm: readonly number[],
): RuledView {
  const at = (row: number, column: number): number => cameraFromVertebra[row]?.[column] ?? 0;
  // Centre of the camera in the vertebra frame: -R^T t.
  const centre = [0, 1, 2].map((axis) => [0, 1, 2].reduce((sum, row) => sum - at(row, axis) * at(row, 3), 0));
  const [left, back, head] = centre.map((mm, axis) => mm - (middleMm[axis] ?? 0)) as [number, number, number];
  return {
    ...FIRST_VIEW,
    vertical_mm: Math.round(back),
    horizontal_mm: Math.round(Math.hypot(left, head)),
    azimuth_deg: Math.round((Math.atan2(left, -head) * 180) / Math.PI),
  };
}

const KEY = "coaxial-ruler";

/** Last input on this tablet for this case; null if none. */
export function storedView(caseId: string): RuledView | null {
  try {
    const stored: unknown = JSON.parse(localStorage.getItem(`${KEY} ${caseId}`) ?? "null");
    return typeof stored === "object" && stored !== null ? { ...FIRST_VIEW, ...stored } : null;
  } catch {
    return null;
  }
}

export function storeView(caseId: string, view: RuledView): void {
  try {
    localStorage.setItem(`${KEY} ${caseId}`, JSON.stringify(view));
  } catch {
    // Without storage the page asks again.
  }
}
