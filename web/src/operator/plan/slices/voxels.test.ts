import { expect, test } from "vitest";
import { indexFromLps, sliceIndexAt } from "./voxels";

/** Columns run to the patient's right; slices are 2 mm apart and slightly tilted. */
const CT = {
  size_ijk: [100, 100, 30],
  lps_from_ijk: [
    [-0.5, 0, 0, 25],
    [0, 0.5, 0.5, -20],
    [0, 0, 2, 100],
    [0, 0, 0, 1],
  ],
};

test("a voxel's own place leads back to it", () => {
  // i=10, j=20, k=3: x = 25 - 5, y = -20 + 10 + 1.5, z = 100 + 6.
  expect(indexFromLps(CT, [20, -8.5, 106])).toEqual([10, 20, 3]);
});

test.each([
  [106.9, 3],
  [107.1, 4],
  [0, 0],
  [999, 29],
])("z = %d mm lies nearest to slice %d", (z, index) => {
  expect(sliceIndexAt(CT, [0, 0, z])).toBe(index);
});
