// Parts of the plan that the registration pages need.

interface PlannedLandmark {
  name: string;
  pointMm: number[];
}

export interface PlannedVertebra {
  name: string;
  sides: string[];
  landmarks: PlannedLandmark[];
  hasReference: boolean;
}

/** Vertebrae of a plan; malformed ones are omitted. */
export function plannedVertebrae(plan: Record<string, unknown>): PlannedVertebra[] {
  return recordsIn(plan["vertebrae"]).map((one) => ({
    name: String(one["name"]),
    sides: recordsIn(one["channels"]).map((channel) => String(channel["side"])),
    landmarks: recordsIn(one["landmarks"]).map((landmark) => ({
      name: String(landmark["name"]),
      pointMm: numbersIn(landmark["point_lps_mm"]),
    })),
    hasReference: recordsIn(one["references"]).length > 0,
  }));
}

/** Landmarks used by a registration; they cannot be used for its check. */
export function usedLandmarks(madeFrom: Record<string, unknown>): string[] {
  return recordsIn(madeFrom["points"])
    .filter((one) => one["used"] === true)
    .map((one) => String(one["landmark"]));
}

function recordsIn(value: unknown): Record<string, unknown>[] {
  return Array.isArray(value)
    ? value.filter((one): one is Record<string, unknown> => typeof one === "object" && one !== null)
    : [];
}

function numbersIn(value: unknown): number[] {
  return Array.isArray(value) ? value.filter((one): one is number => typeof one === "number") : [];
}
