import { expect, test } from "vitest";
import { shadeOf } from "./shade";

test.each([
  ["L3", "L4"],
  ["C7", "T1"],
  ["T12", "L1"],
  ["L5", "S1"],
])("%s and %s have different shades", (upper, lower) => {
  expect(shadeOf(upper)).not.toBe(shadeOf(lower));
});
