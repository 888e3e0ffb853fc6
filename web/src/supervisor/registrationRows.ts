// Values of a registration for display, with their limits where they were stored.
import type { SupervisorTexts } from "../texts/supervisor/en";

type NumberName = keyof SupervisorTexts["registration"]["numbers"];

interface Row {
  name: NumberName;
  value: number;
  unit: "mm" | "°" | "";
  limit: number | null;
  past: boolean;
}

const LIMIT_OF: Partial<Record<NumberName, string>> = {
  fre_rms_mm: "max_fre_mm",
  leave_one_out_mm: "max_left_out_mm",
  tre_at_entry_mm: "max_tre_mm",
  rms_mm: "max_rms_mm",
};
const NAMES: readonly NumberName[] = [
  "points",
  "needles",
  "fre_rms_mm",
  "leave_one_out_mm",
  "worst_offset_mm",
  "rms_mm",
  "tre_at_entry_mm",
  "depth_sd_mm",
  "across_sd_mm",
  "tilt_sd_deg",
  "turn_sd_deg",
  "nudges",
  "nudged_mm",
  "nudged_deg",
];

export function rowsOf(numbers: Record<string, unknown>): Row[] {
  return NAMES.flatMap((name) => {
    const value = numbers[name];
    if (typeof value !== "number") return [];
    const stated = LIMIT_OF[name] === undefined ? null : numbers[LIMIT_OF[name]];
    const limit = typeof stated === "number" ? stated : null;
    const unit = name.endsWith("_mm") ? "mm" : name.endsWith("_deg") ? "°" : "";
    return [{ name, value, unit, limit, past: limit !== null && value > limit }];
  });
}
