import { describe, expect, test } from "vitest";
import {
  beyondMm,
  frameOf,
  lpsFromPlane,
  lpsFromPx,
  nearPart,
  planeFromLps,
  pxFromLps,
  type Place,
} from "./place";
import type { Vec3 } from "./vectors";

const EDGES = { left: "R", right: "L", top: "A", bottom: "P" };

/** An axial slice at z = 12: columns 0.5 mm apart to the patient's left, rows 0.75 mm apart backwards. */
const AXIAL: Place = {
  width_px: 200,
  height_px: 100,
  pixel_mm: [0.5, 0.75],
  lps_from_px: [
    [0.5, 0, -40],
    [0, 0.75, -30],
    [0, 0, 12],
  ],
  normal_lps: [0, 0, 1],
  edges: EDGES,
  at_mm: 12,
};

/** A sagittal one at x = -7: columns 1 mm backwards, rows 2 mm to the feet from z = 50. */
const SAGITTAL: Place = {
  ...AXIAL,
  pixel_mm: [1, 2],
  lps_from_px: [
    [0, 0, -7],
    [1, 0, -60],
    [0, -2, 50],
  ],
  at_mm: -7,
};

/** From a scanner with a tilted gantry: rows run backwards and slightly to the head. */
const TILTED: Place = {
  ...AXIAL,
  pixel_mm: [1, 1],
  lps_from_px: [
    [1, 0, 10],
    [0, 0.8, 20],
    [0, 0.6, 30],
  ],
  at_mm: null,
};

describe("a pixel's place in the patient", () => {
  test.each([
    ["the first pixel", AXIAL, [0, 0], [-40, -30, 12]],
    ["between pixels", AXIAL, [80, 40], [0, 0, 12]],
    ["a sagittal slice", SAGITTAL, [60, 25], [-7, 0, 0]],
    ["a tilted frame", TILTED, [2, 10], [12, 28, 36]],
  ] as const)("%s", (_, place, px, lps) => {
    expect(lpsFromPx(place, px)).toEqual(lps);
    pxFromLps(place, lps).forEach((value, i) => {
      expect(value).toBeCloseTo(px[i] ?? NaN, 9);
    });
  });

  test("drawings are made in mm of the plane, so that oblong pixels do not bend them", () => {
    expect(planeFromLps(AXIAL, [0, 0, 12])).toEqual([40, 30]);
    expect(lpsFromPlane(AXIAL, [40, 30])).toEqual([0, 0, 12]);
    expect(frameOf(AXIAL)).toEqual({ x: -0.25, y: -0.375, width: 100, height: 75 });
  });

  test("a point off the slice is drawn at its projection, with its distance", () => {
    expect(pxFromLps(AXIAL, [0, 0, 99])).toEqual([80, 40]);
    expect(beyondMm(AXIAL, [3, 4, 14])).toBe(2);
    // Back is right and feet are down: the view is to the patient's right, where x decreases.
    expect(beyondMm(SAGITTAL, [-9, 0, 0])).toBe(2);
    expect(beyondMm(TILTED, [10, 20 - 0.6, 30 + 0.8])).toBeCloseTo(1, 9);
  });
});

describe("the part of a line near a slice", () => {
  const at = (z: number): Vec3 => [0, 0, z];
  test.each([
    ["through it", at(2), at(22), [at(10), at(14)]],
    ["begins within it", at(12), at(22), [at(12), at(14)]],
    ["in the plane", [0, 0, 12] as Vec3, [9, 0, 12] as Vec3, [at(12), [9, 0, 12]]],
    ["all behind it", at(20), at(30), null],
    ["beside it and level", at(20), [5, 0, 20] as Vec3, null],
  ] as const)("%s", (_, from, to, part) => {
    expect(nearPart(AXIAL, from, to, 2)).toEqual(part);
  });
});
