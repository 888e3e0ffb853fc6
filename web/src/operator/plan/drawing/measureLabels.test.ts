import { expect, test } from "vitest";
import type { Vec2 } from "../slices/place";
import { besideLeg, HALF_TEXT, insideAngle } from "./measureLabels";

const STAGE = { width: 512, height: 420 };

test.each([
  ["a right angle", [205, 110], [205, 190], [335, 190]],
  ["one to the left", [335, 110], [335, 220], [205, 220]],
  ["an acute angle", [205, 110], [205, 240], [333, 180]],
  ["an obtuse angle", [150, 200], [250, 220], [370, 170]],
  ["near the edge", [4, 110], [4, 240], [140, 240]],
] as const)("the figures of %s neither cover each other nor leave the picture", (_, from, vertex, to) => {
  const labels: Vec2[] = [
    besideLeg(from, vertex, to, STAGE),
    besideLeg(vertex, to, from, STAGE),
    insideAngle(from, vertex, to, STAGE),
  ];
  labels.forEach(([x, y], i) => {
    expect(x - HALF_TEXT[0]).toBeGreaterThan(0);
    expect(x + HALF_TEXT[0]).toBeLessThan(STAGE.width);
    for (const other of labels.slice(i + 1)) {
      // The angle is shorter than a length with its unit.
      const both = HALF_TEXT[0] + (other === labels[2] ? 28 : HALF_TEXT[0]);
      const isApart = Math.abs(x - other[0]) > both || Math.abs(y - other[1]) > 2 * HALF_TEXT[1];
      expect(isApart).toBe(true);
    }
  });
});

test("the figure of a distance alone is beside it", () => {
  expect(besideLeg([100, 200], [200, 200], undefined, STAGE)).toEqual([150, 182]);
});
