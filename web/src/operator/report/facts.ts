// Values of a document for the report; its content is not trusted.
import type { ReportTexts } from "../../texts/report/en";

type Content = Readonly<Record<string, unknown>>;
type FactName = keyof ReportTexts["facts"];

export interface Fact {
  name: FactName;
  value: number | string;
  unit: "mm" | "°" | "px" | "";
  /** The limit at that time; null if there was none. */
  limit: number | null;
}

/** Kinds of documents that are opened for the report. */
export const TELLING: ReadonlySet<string> = new Set([
  "camera",
  "tool",
  "registration",
  "check",
  "plan",
  "placement",
]);

/** Missing values are omitted, never guessed. */
export function factsOf(kind: string, content: Content): Fact[] {
  if (kind === "camera") return some(mm("fit", part(content["report"])["rms_px"], null, "px"));
  if (kind === "tool") return some(mm("tip", part(content["pivot"])["rms_3d_mm"]));
  if (kind === "plan")
    return some(textFact("vertebra", content["vertebra"]), textFact("side", content["side"]));
  if (kind === "check") return checkFacts(content);
  if (kind === "registration") return registrationFacts(content);
  if (kind === "placement") return placementFacts(content);
  return [];
}

function placementFacts(content: Content): Fact[] {
  const figures = part(content["figures"]);
  const figure = (name: FactName, of: string, unit: Fact["unit"]): Fact | null =>
    mm(name, part(figures[of])["value"], part(figures[of])["limit"], unit);
  return some(
    mm("diameter", content["diameter_mm"]),
    mm("length", content["length_mm"]),
    figure("entryOffset", "entry", "mm"),
    figure("angle", "angle", "°"),
    figure("error95", "error", "mm"),
    mm("screwClearance", content["clearance_mm"]),
    textFact("grade", content["grade"]),
  );
}

function checkFacts(content: Content): Fact[] {
  return some(
    textFact("landmark", content["landmark"]),
    mm("distance", content["distance_mm"], content["max_mm"]),
    mm("known", content["maximum_error_mm"], content["limit_mm"]),
    mm("tipMoved", content["rms_3d_mm"]),
  );
}

function registrationFacts(content: Content): Fact[] {
  const numbers = part(content["numbers"]);
  return some(
    textFact("method", content["method"]),
    mm("atEntry", numbers["tre_at_entry_mm"], numbers["max_tre_mm"]),
    mm("points", numbers["fre_rms_mm"], numbers["max_fre_mm"]),
    mm("leftOut", numbers["leave_one_out_mm"], numbers["max_left_out_mm"]),
    mm("needle", numbers["worst_offset_mm"]),
    mm("surface", numbers["rms_mm"], numbers["max_rms_mm"]),
    mm("nudged", numbers["nudged_mm"]),
  );
}

function mm(name: FactName, value: unknown, limit: unknown = null, unit: Fact["unit"] = "mm"): Fact | null {
  return number(value) === null ? null : { name, value: number(value) ?? 0, unit, limit: number(limit) };
}

function textFact(name: FactName, value: unknown): Fact | null {
  return typeof value === "string" && value !== "" ? { name, value, unit: "", limit: null } : null;
}

const some = (...facts: (Fact | null)[]): Fact[] => facts.filter((one) => one !== null);
const number = (value: unknown): number | null =>
  typeof value === "number" && Number.isFinite(value) ? value : null;
const part = (value: unknown): Content =>
  typeof value === "object" && value !== null ? (value as Content) : {};
