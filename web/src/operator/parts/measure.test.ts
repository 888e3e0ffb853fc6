import { expect, test } from "vitest";
import { isWithin } from "./Measure";

test.each([
  ["below the most that is allowed", 0.8, "most", 1, true],
  ["exactly at it", 1, "most", 1, true],
  ["above it", 1.01, "most", 1, false],
  ["above the least that is wanted", 12, "least", 10, true],
  ["below it", 9, "least", 10, false],
] as const)("%s", (_, value, kind, limit, within) => {
  expect(isWithin(value, { kind, value: limit })).toBe(within);
});

test("what is not known, or held against nothing, is neither", () => {
  expect(isWithin(null, { kind: "most", value: 1 })).toBeNull();
  expect(isWithin(Number.NaN, { kind: "most", value: 1 })).toBeNull();
  expect(isWithin(1, undefined)).toBeNull();
});
