import { expect, test } from "vitest";
import { neighbourOf } from "./catalogue";

test.each([
  [5, 1, 6.5],
  [5, -1, 4],
  [4.7, 1, 5],
  [6.5, 1, null],
  [4, -1, null],
] as const)("from %d mm in direction %d comes %j", (now, direction, next) => {
  expect(neighbourOf([6.5, 4, 5], now, direction)).toBe(next);
});
