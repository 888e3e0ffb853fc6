import { expect, test } from "vitest";
import { shownNumbers } from "./numbers";

test.each([
  ["rms_px", 0.1234, "rms", "0.12 px"],
  ["distance_mm", 2, "distance", "2.00 mm"],
  ["turn_deg", -0.5, "turn", "\u22120.50 °"],
  ["age_min", 12.4, "age", "12 min"],
  ["coverage_ratio", 0.875, "coverage", "88 %"],
  ["landmarks", 4, "landmarks", "4"],
  ["landmark", "left process", "landmark", "left process"],
  ["passed", true, "passed", "✓"],
] as const)("%s", (key, value, name, shown) => {
  expect(shownNumbers({ [key]: value })).toEqual([[name, shown]]);
});

test("what is not known is left out, and is not shown as a number", () => {
  expect(shownNumbers({ rms_px: null, fre_mm: Number.NaN, name: "" })).toEqual([]);
});
