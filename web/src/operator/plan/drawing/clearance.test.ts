import { expect, test } from "vitest";
import { levelOf, partsOf } from "./clearance";

const MARGIN_MM = 0.5;

test.each([
  [0.5, "ample"],
  [0.499, "low"],
  [0, "low"],
  [-0.001, "breach"],
] as const)("with %d mm left of a margin of 0.5 mm the level is %s", (clearance, level) => {
  expect(levelOf(clearance, MARGIN_MM)).toBe(level);
});

test("a screw is divided where its clearance passes a limit, on the safe side", () => {
  const along = { depth_mm: [10, 12, 14, 16, 18], clearance_mm: [2, 1, 0.2, -0.3, 0.8] };
  expect(partsOf(along, MARGIN_MM, 40)).toEqual([
    { from: 0, to: 10, level: "unknown" },
    { from: 10, to: 12, level: "ample" },
    { from: 12, to: 14, level: "low" },
    { from: 14, to: 18, level: "breach" },
    { from: 18, to: 40, level: "unknown" },
  ]);
});

test("known from the entry to the end, nothing is unknown", () => {
  const along = { depth_mm: [0, 20, 40], clearance_mm: [2, 2, 2] };
  expect(partsOf(along, MARGIN_MM, 40)).toEqual([{ from: 0, to: 40, level: "ample" }]);
});

test("without a known wall all of the screw is unknown, and never ample", () => {
  expect(partsOf(null, MARGIN_MM, 40)).toEqual([{ from: 0, to: 40, level: "unknown" }]);
});
