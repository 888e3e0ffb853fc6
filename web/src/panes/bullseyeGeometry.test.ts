import { describe, expect, test } from "vitest";
import { along } from "../live/builders";
import { bullseyeGeometry, clampToReach } from "./bullseyeGeometry";

test("a drill within the border is drawn where it is", () => {
  const drawn = bullseyeGeometry(along());
  expect(drawn.tip).toEqual([1, -0.5]);
  expect(drawn.way).toEqual([
    [0.6, 0.8],
    [2, -3],
  ]);
  expect(drawn.end).toEqual([2, -3]);
  expect(drawn.nearest).toEqual([2.6, -0.5]);
  expect(drawn.arrow).toBeNull();
});

test("the ellipse lies around the tip with the half axes that were sent", () => {
  const ellipse = bullseyeGeometry(along()).ellipse ?? [];
  const right = ellipse.map(([x]) => x - 1);
  const up = ellipse.map(([, y]) => y + 0.5);
  expect(Math.max(...right)).toBeCloseTo(0.5, 6);
  expect(Math.max(...up)).toBeCloseTo(0.3, 6);
});

test("a tip beyond the border is an arrow towards it, and nothing else", () => {
  const drawn = bullseyeGeometry(along({ tip_mm: [0, -30] }));
  expect(drawn.arrow?.[1]).toEqual([0, -8]);
  expect([drawn.tip, drawn.way, drawn.end, drawn.ellipse, drawn.nearest]).toEqual([
    null,
    null,
    null,
    null,
    null,
  ]);
});

test("a drill across the channel is a tip without a line", () => {
  const drawn = bullseyeGeometry(along({ at_entry_mm: null, at_target_mm: null, nearest_mm: null }));
  expect(drawn.way).toEqual([
    [1, -0.5],
    [1, -0.5],
  ]);
  expect(drawn.end).toBeNull();
});

describe.each([
  [
    [3, 4],
    [0, 0],
    [3, 4],
  ],
  [
    [30, 0],
    [0, 0],
    [8, 0],
  ],
  [
    [2, 100],
    [2, 0],
    [2, Math.sqrt(60)],
  ],
] as const)("%j from %j", (at, tip, expected) => {
  test("is held within reach along its own line", () => {
    const held = clampToReach(at, tip, 8);
    expect(held[0]).toBeCloseTo(expected[0], 9);
    expect(held[1]).toBeCloseTo(expected[1], 9);
  });
});
