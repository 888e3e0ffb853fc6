import { expect, test } from "vitest";
import { keepUnits } from "./keepUnits";

test.each([
  ["NEAR MEDIAL WALL 0.5 mm", "NEAR MEDIAL WALL 0.5\u00a0mm"],
  ["in 2 mm 1 %, limit 5 %", "in 2\u00a0mm 1\u00a0%, limit 5\u00a0%"],
  ["40 mm/s × 60 ms", "40\u00a0mm/s × 60\u00a0ms"],
  ["4 screws, 2.5 mm medial", "4 screws, 2.5\u00a0mm medial"],
])("%s", (text, expected) => {
  expect(keepUnits(text)).toBe(expected);
});
