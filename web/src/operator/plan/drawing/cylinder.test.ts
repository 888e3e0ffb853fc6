import { describe, expect, test } from "vitest";
import type { Place } from "../slices/place";
import type { Vec3 } from "../slices/vectors";
import { cylinderOnSlice } from "./cylinder";

/** An axial slice at z = 0. */
const AXIAL = {
  pixel_mm: [1, 1],
  lps_from_px: [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 0],
  ],
} as unknown as Place;

const FORWARDS: [Vec3, Vec3] = [
  [5, 20, 0],
  [5, -20, 0],
];
const shifted = (z: number): [Vec3, Vec3] => [
  [5, 20, z],
  [5, -20, z],
];

const reach = (points: Vec3[], axis: 0 | 1 | 2): [number, number] => {
  const values = points.map((one) => one[axis]);
  return [Math.min(...values), Math.max(...values)];
};

describe("a cylinder of 3 mm radius cut by a slice", () => {
  test("through its axis shows its whole width and length", () => {
    const cut = cylinderOnSlice(AXIAL, ...FORWARDS, 3);
    expect(reach(cut, 0)).toEqual([2, 8]);
    expect(reach(cut, 1)).toEqual([-20, 20]);
  });

  test("beside its axis shows the chord: 1.8 mm off, 2.4 mm to each side", () => {
    const [low, high] = reach(cylinderOnSlice(AXIAL, ...shifted(1.8), 3), 0);
    expect(low).toBeCloseTo(2.6, 9);
    expect(high).toBeCloseTo(7.4, 9);
  });

  test("missed by the slice shows nothing", () => {
    expect(cylinderOnSlice(AXIAL, ...shifted(3.1), 3)).toEqual([]);
  });

  test("square to its axis shows a circle, between its ends only", () => {
    const cut = cylinderOnSlice(AXIAL, [1, 2, 10], [1, 2, -10], 3);
    expect(cut.every((one) => Math.abs(Math.hypot(one[0] - 1, one[1] - 2) - 3) < 1e-9)).toBe(true);
    expect(cylinderOnSlice(AXIAL, [1, 2, 30], [1, 2, 10], 3)).toEqual([]);
    expect(cylinderOnSlice(AXIAL, [1, 2, -10], [1, 2, 10], 3)).toHaveLength(cut.length);
  });

  test("square to its axis at an end shows the end, whose place is rounded", () => {
    expect(cylinderOnSlice(AXIAL, [1, 2, -0.001], [1, 2, -10], 3)).toHaveLength(48);
    expect(cylinderOnSlice(AXIAL, [1, 2, 10], [1, 2, 0.001], 3)).toHaveLength(48);
    expect(cylinderOnSlice(AXIAL, [1, 2, -0.1], [1, 2, -10], 3)).toEqual([]);
  });

  test("aslant shows an ellipse: at 30 degrees to the slice, twice as long as wide", () => {
    const along: Vec3 = [0, Math.cos(Math.PI / 6) * 50, Math.sin(Math.PI / 6) * 50];
    const cut = cylinderOnSlice(AXIAL, [0, -along[1], -along[2]], along, 3);
    expect(cut.every((one) => Math.abs(one[2]) < 1e-9)).toBe(true);
    const [low, high] = reach(cut, 1);
    expect(high - low).toBeGreaterThan(11);
    expect(high - low).toBeLessThanOrEqual(12);
    expect(Math.max(...cut.map((one) => (one[0] / 3) ** 2 + (one[1] / 6) ** 2))).toBeCloseTo(1, 6);
  });

  test("nearly square to its axis shows its whole ellipse", () => {
    // At 3 degrees the slice leaves the cylinder within a third of a millimetre of its length.
    const tilt = (3 * Math.PI) / 180;
    const upwards: [Vec3, Vec3] = [
      [5, 0, -20],
      [5 + 40 * Math.tan(tilt), 0, 20],
    ];
    const cut = cylinderOnSlice(AXIAL, ...upwards, 3);
    const [left, right] = reach(cut, 0);
    expect(right - left).toBeCloseTo(6 / Math.cos(tilt), 3);
    const [top, bottom] = reach(cut, 1);
    expect(bottom - top).toBeCloseTo(6, 1);
  });
});
