import { expect, test } from "vitest";
import type { Vec2 } from "../slices/place";
import { knobAt, knobsOf, type Knobs } from "./knobs";

const STAGE = { width: 400, height: 300 };
const SIZE = { awayPx: 46, radiusPx: 28 };

function placed(entry: Vec2, target: Vec2): Vec2[] {
  const knobs: Knobs = knobsOf(entry, target);
  const middle: Vec2 = [(entry[0] + target[0]) / 2, (entry[1] + target[1]) / 2];
  return [
    knobAt(entry, knobs.entry, STAGE, SIZE),
    knobAt(middle, knobs.whole, STAGE, SIZE),
    knobAt(target, knobs.target, STAGE, SIZE),
  ];
}

test.each([
  ["along the slice", [200, 80], [210, 220]],
  ["nearly across it", [200, 150], [203, 151]],
  ["exactly across it", [200, 150], [200, 150]],
] as const)("the knobs of a channel %s do not cover each other", (_, entry, target) => {
  const knobs = placed(entry, target);
  knobs.forEach((one, i) => {
    for (const other of knobs.slice(i + 1)) {
      expect(Math.hypot(one[0] - other[0], one[1] - other[1])).toBeGreaterThan(2 * SIZE.radiusPx);
    }
  });
});

test("a knob is in the picture as long as its point is", () => {
  expect(knobAt([390, 10], [1, -1], STAGE, SIZE)).toEqual([400 - 28, 28]);
  expect(knobAt([200, 150], [0, -3], STAGE, SIZE)).toEqual([200, 150 - 46]);
  expect(knobAt([450, 150], [1, 0], STAGE, SIZE)).toEqual([496, 150]);
});
