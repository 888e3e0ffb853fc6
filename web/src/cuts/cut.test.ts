import { expect, test } from "vitest";
import { drawCut, inverseAffine, type CutPlane, type Voxels } from "./cut";

/** 3 x 2 x 2 voxels of 2 mm with HU = 10 i + 100 j + 1000 k; voxel (0, 0, 0) is at (5, 0, 0). */
const AFFINE = [
  [2, 0, 0, 5],
  [0, 2, 0, 0],
  [0, 0, 2, 0],
  [0, 0, 0, 1],
];
const VOXELS: Voxels = {
  hu: Int16Array.from(
    { length: 12 },
    (_, n) => 10 * (n % 3) + 100 * (Math.floor(n / 3) % 2) + 1000 * Math.floor(n / 6),
  ),
  size: [3, 2, 2],
  indexFromLps: inverseAffine(AFFINE),
};
/** 0 HU is 0, 2550 HU is 255. */
const GREY = { window_hu: 2550, level_hu: 1275 };

/** One row of pixels along x, 1 mm apart, at given y and z. */
function line(y: number, z: number, fromX: number, count: number): number[][] {
  const plane: CutPlane = {
    lps_from_px: [
      [1, 0, fromX],
      [0, 1, y],
      [0, 0, z],
    ],
    width_px: count,
    height_px: 1,
  };
  const pixels = new Uint8ClampedArray(count * 4).fill(77);
  drawCut(VOXELS, plane, GREY, pixels);
  return Array.from({ length: count }, (_, n) => [pixels[4 * n] ?? NaN, pixels[4 * n + 3] ?? NaN]);
}

test("between voxels the grey is linear, and outside of them the pixel is transparent", () => {
  // x = 4 is half a voxel outside; 5, 6 .. 9 are indices 0, 0.5 .. 2; 10 is outside again. k = 0.5: 500 HU.
  const seen = line(2, 1, 4, 7);
  expect(seen.map(([, alpha]) => alpha)).toEqual([0, 255, 255, 255, 255, 255, 0]);
  expect(seen.slice(1, 6).map(([grey]) => grey)).toEqual([60, 60, 61, 62, 62]);
});

test("the inverse of an oblique affine undoes it", () => {
  const affine = [
    [0.5, 0.1, -0.2, 12],
    [-0.1, 0.6, 0.3, -40],
    [0.2, -0.1, 1.2, 7],
    [0, 0, 0, 1],
  ];
  const inverse = inverseAffine(affine);
  const index = [3, 5, 2];
  const place = affine.slice(0, 3).map(([a = 0, b = 0, c = 0, d = 0]) => a * 3 + b * 5 + c * 2 + d);
  inverse.forEach(([a = 0, b = 0, c = 0, d = 0], row) => {
    expect(a * (place[0] ?? 0) + b * (place[1] ?? 0) + c * (place[2] ?? 0) + d).toBeCloseTo(
      index[row] ?? NaN,
      9,
    );
  });
});
