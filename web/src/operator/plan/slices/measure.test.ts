import { describe, expect, test } from "vitest";
import { angleDeg, lengthsMm, withPoint, withTap } from "./measure";
import { planeFromLps, type Place, type Vec2 } from "./place";
import { projectionOf } from "./projection";
import type { Vec3 } from "./vectors";

const BASE = {
  width_px: 200,
  height_px: 100,
  normal_lps: [0, 0, 1],
  edges: { left: "R", right: "L", top: "A", bottom: "P" },
  at_mm: 12,
};

/** Columns are 0.5 mm apart, rows 0.75 mm. */
const AXIAL: Place = {
  ...BASE,
  pixel_mm: [0.5, 0.75],
  lps_from_px: [
    [0.5, 0, -40],
    [0, 0.75, -30],
    [0, 0, 12],
  ],
};

/** Columns are 0.75 mm apart and run backwards, rows 3 mm apart and run to the feet. */
const SAGITTAL: Place = {
  ...BASE,
  pixel_mm: [0.75, 3],
  lps_from_px: [
    [0, 0, -7],
    [0.75, 0, -60],
    [0, -3, 50],
  ],
};

/** Oblique: columns along (0.6, 0.8, 0), 0.4 mm apart; rows along (0.48, -0.36, -0.8), 0.4 mm apart. */
const OBLIQUE: Place = {
  ...BASE,
  pixel_mm: [0.4, 0.4],
  lps_from_px: [
    [0.24, 0.192, 10],
    [0.32, -0.144, 20],
    [0, -0.32, 30],
  ],
};

/** Points of a slice as tapped on the page at these pixels of the slice. */
function tapped(place: Place, pixels: readonly Vec2[]): Vec3[] {
  const stage = { width: 517, height: 389 };
  const projection = projectionOf(place, { centre: [17, 29], pxPerMm: 3.7 }, stage);
  return pixels.map(([u, v]) => {
    const inPlane: Vec2 = [u * (place.pixel_mm[0] ?? 1), v * (place.pixel_mm[1] ?? 1)];
    return projection.lpsAt([
      stage.width / 2 + (inPlane[0] - 17) * 3.7,
      stage.height / 2 + (inPlane[1] - 29) * 3.7,
    ]);
  });
}

describe("distances are those of the voxels", () => {
  test.each([
    ["along the columns", AXIAL, [10, 20], [30, 20], 10],
    ["along the rows", AXIAL, [10, 20], [10, 40], 15],
    ["across both, 3 by 4 mm", AXIAL, [2, 8], [8, 8 + 4 / 0.75], 5],
    ["over three thick slices", SAGITTAL, [40, 10], [40, 13], 9],
    ["12 by 9 mm over thick slices", SAGITTAL, [40, 10], [40 + 16, 13], 15],
    ["oblique, 30 by 40 pixels of 0.4 mm", OBLIQUE, [5, 5], [35, 45], 20],
  ] as const)("%s", (_, place, from, to, mm) => {
    expect(lengthsMm(tapped(place, [from, to]))).toEqual([expect.closeTo(mm, 9)]);
  });

  test("from one slice to another, through the patient", () => {
    const [[from], [to]] = [tapped(AXIAL, [[80, 40]]), tapped({ ...AXIAL, lps_from_px: AT_24 }, [[90, 60]])];
    if (from === undefined || to === undefined) throw new Error("no point");
    expect(lengthsMm([from, to])[0]).toBeCloseTo(Math.hypot(5, 15, 12), 9);
  });
});

const AT_24 = [
  [0.5, 0, -40],
  [0, 0.75, -30],
  [0, 0, 24],
];

describe("angles at the second point are those of the voxels", () => {
  test.each([
    ["a right angle", AXIAL, [10, 20], [10, 40], [50, 40], 90],
    // 6 mm by 6 mm are 12 columns and 8 rows.
    ["45 degrees in anisotropic pixels", AXIAL, [40, 20], [20, 20], [32, 28], 45],
    ["45 degrees over thick slices", SAGITTAL, [60, 10], [40, 10], [52, 13], 45],
    ["30 degrees on an oblique slice", OBLIQUE, [50, 7], [10, 7], [10 + 10 * Math.sqrt(3), 17], 30],
    ["straight on", OBLIQUE, [5, 5], [15, 10], [25, 15], 180],
  ] as const)("%s", (_, place, from, vertex, to, deg) => {
    expect(angleDeg(tapped(place, [from, vertex, to]))).toBeCloseTo(deg, 6);
  });

  test("without a third point, or on one place, there is none", () => {
    expect(angleDeg(tapped(AXIAL, [[1, 1], [5, 5]]))).toBeNull(); // prettier-ignore
    expect(angleDeg([[1, 2, 3], [1, 2, 3], [4, 5, 6]])).toBeNull(); // prettier-ignore
  });
});

test("a tap after three points begins another measurement", () => {
  const three = tapped(AXIAL, [[1, 1], [5, 5], [9, 1]]); // prettier-ignore
  expect(withTap(three.slice(0, 2), [0, 0, 0])).toHaveLength(3);
  expect(withTap(three, [0, 0, 0])).toEqual([[0, 0, 0]]);
  expect(withPoint(three, 1, [7, 7, 7])).toEqual([three[0], [7, 7, 7], three[2]]);
});

test("a tapped pixel's point is drawn at that pixel", () => {
  const [point] = tapped(OBLIQUE, [[12, 34]]);
  if (point === undefined) throw new Error("no point");
  const [x, y] = planeFromLps(OBLIQUE, point);
  expect([x / 0.4, y / 0.4]).toEqual([expect.closeTo(12, 9), expect.closeTo(34, 9)]);
});
