import { expect, test } from "vitest";
import { isWithin } from "./Measure";

test.each([
  ["below the most that is allowed", 0.8, "max", 1, true],
  ["exactly at it", 1, "max", 1, true],
  ["above it", 1.01, "max", 1, false],
  ["above the least that is wanted", 12, "min", 10, true],
  ["below it", 9, "min", 10, false],
] as const)("%s", (_, value, kind, limit, within) => {
  expect(isWithin(value, { kind, value: limit })).toBe(within);
});

test("what is not known, or held against nothing, is neither", () => {
  expect(isWithin(null, { kind: "max", value: 1 })).toBeNull();
  expect(isWithin(Number.NaN, { kind: "max", value: 1 })).toBeNull();
  expect(isWithin(1, undefined)).toBeNull();
});
