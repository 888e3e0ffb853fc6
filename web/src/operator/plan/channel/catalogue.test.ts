import { expect, test } from "vitest";
import { neighbourOf, rangesWith } from "./catalogue";

test.each([
  [5, 1, 6.5],
  [5, -1, 4],
  [4.7, 1, 5],
  [6.5, 1, null],
  [4, -1, null],
] as const)("from %d mm in direction %d comes %j", (now, direction, next) => {
  expect(neighbourOf([6.5, 4, 5], now, direction)).toBe(next);
});

const RANGES = [
  { name: "Standard", diameters_mm: [5.5, 6.5], lengths_mm: [40, 45] },
  { name: "Long", diameters_mm: [6.5], lengths_mm: [45, 60] },
];

test.each([
  [{ diameter_mm: 5.5, length_mm: 40 }, ["Standard"]],
  [{ diameter_mm: 6.5, length_mm: 45 }, ["Standard", "Long"]],
  [{ diameter_mm: 5.5, length_mm: 60 }, []],
])("a screw of %j is offered by %j", (size, names) => {
  expect(rangesWith(RANGES, size)).toEqual(names);
});
