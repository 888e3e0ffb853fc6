import { expect, test } from "vitest";
import { factsOf } from "./facts";

test("a check has its landmark, distance and limit", () => {
  const content = { landmark: "left process", distance_mm: 0.8, max_mm: 2, passed: true, run: "7f" };
  expect(factsOf("check", content)).toEqual([
    { name: "landmark", value: "left process", unit: "", limit: null },
    { name: "distance", value: 0.8, unit: "mm", limit: 2 },
  ]);
});

test("a registration has its method and its values with limits, without settings", () => {
  const numbers = { fre_rms_mm: 0.4, max_fre_mm: 1, tre_at_entry_mm: 0.9, max_tre_mm: 2, points: 4 };
  expect(factsOf("registration", { method: "points", numbers })).toEqual([
    { name: "method", value: "points", unit: "", limit: null },
    { name: "atEntry", value: 0.9, unit: "mm", limit: 2 },
    { name: "points", value: 0.4, unit: "mm", limit: 1 },
  ]);
});

test("a camera has its fit in pixels", () => {
  expect(factsOf("camera", { report: { rms_px: 0.2 } })).toEqual([
    { name: "fit", value: 0.2, unit: "px", limit: null },
  ]);
});

test.each([
  ["tool", {}],
  ["check", { distance_mm: "near", max_mm: 2 }],
  ["registration", { numbers: null }],
  ["ct", { shape: [1, 2, 3] }],
] as const)("what a %s does not say is not guessed", (kind, content) => {
  expect(factsOf(kind, content)).toEqual([]);
});
