import { expect, test } from "vitest";
import { armsOf } from "./tilts";

test("each side has its own reach, and what leans the other way counts for nothing", () => {
  expect(armsOf([-10, 25, 5, 8], 20)).toEqual([
    { way: "up", reachedDeg: 25, ratio: 1 },
    { way: "down", reachedDeg: 10, ratio: 0.5 },
    { way: "left", reachedDeg: 8, ratio: 0.4 },
    { way: "right", reachedDeg: 0, ratio: 0 },
  ]);
});

test("before the first view nothing is reached", () => {
  expect(armsOf([], 20).map((arm) => arm.reachedDeg)).toEqual([0, 0, 0, 0]);
});
