import { describe, expect, test } from "vitest";
import {
  beyondMm,
  downOf,
  normalOf,
  planeFromLps,
  rightOf,
  type PixelGrid,
} from "../operator/plan/slices/place";
import { unit, type Vec3 } from "../operator/plan/slices/vectors";
import { cutGrid, directionLetter, fieldOf, type CutName, type Pose } from "./planes";

const FIELD = { widthMm: 60, heightMm: 40 };
/** From behind, converging towards the midline by a third: a left pedicle (+x) is drilled towards -x. */
const LEFT: Pose = { tip: [14, 10, 0], axis: unit([-1, -3, 0]) };
const RIGHT: Pose = { tip: [-14, 10, 0], axis: unit([1, -3, 0]) };

function letters(grid: PixelGrid): string {
  const [right, down] = [rightOf(grid), downOf(grid)];
  const back = (one: Vec3): Vec3 => [-one[0], -one[1], -one[2]];
  return [back(right), right, back(down), down].map(directionLetter).join("");
}

/** Position of a point relative to the middle of the cut, in mm right and down. */
function seen(name: CutName, pose: Pose, point: Vec3, aheadMm = 0): number[] {
  const grid = cutGrid(name, pose, FIELD, aheadMm);
  const [x, y] = planeFromLps(grid, point);
  return [x - ((grid.width_px - 1) * 0.25) / 2, y - ((grid.height_px - 1) * 0.25) / 2];
}

describe.each([
  ["left", LEFT],
  ["right", RIGHT],
])("the cuts of a drill in the %s pedicle", (_, pose) => {
  test("have the patient's directions at their edges: left, right, top, bottom", () => {
    // Radiological with anterior on top; feet on the left; and as seen from behind a prone patient.
    expect(letters(cutGrid("axial", pose, FIELD, 0))).toBe("RLAP");
    expect(letters(cutGrid("sagittal", pose, FIELD, 0))).toBe("FHAP");
    expect(letters(cutGrid("probe", pose, FIELD, 0))).toBe("LRHF");
  });

  test("show what lies to the patient's left, head and back on that side", () => {
    const { tip } = pose;
    const beside = (by: Vec3): Vec3 => [tip[0] + by[0], tip[1] + by[1], tip[2] + by[2]];
    const [originX, originY] = seen("axial", pose, tip);
    expect(seen("axial", pose, beside([2, 0, 0]))[0]).toBeGreaterThan(originX ?? NaN);
    expect(seen("axial", pose, beside([0, 2, 0]))[1]).toBeGreaterThan(originY ?? NaN);
    expect(seen("sagittal", pose, beside([0, 0, 2]))[0]).toBeCloseTo(2, 9);
    expect(seen("probe", pose, beside([2, 0, 0]))[0]).toBeLessThan(0);
    expect(seen("probe", pose, beside([0, 0, 2]))[1]).toBeCloseTo(-2, 9);
  });

  test("contain the drill's axis, or are square to it at the depth asked for", () => {
    const { tip, axis } = pose;
    for (const name of ["axial", "sagittal"] as const) {
      const normal = normalOf(cutGrid(name, pose, FIELD, 0));
      expect(normal[0] * axis[0] + normal[1] * axis[1] + normal[2] * axis[2]).toBeCloseTo(0, 12);
      // 12 % of the height below the middle.
      const [x, y] = seen(name, pose, tip);
      expect(x).toBeCloseTo(0, 9);
      expect(y).toBeCloseTo(4.8, 9);
    }
    const ahead: Vec3 = [tip[0] + 10 * axis[0], tip[1] + 10 * axis[1], tip[2] + 10 * axis[2]];
    const grid = cutGrid("probe", pose, FIELD, 10);
    const normal = normalOf(grid);
    // The view is along the drill, not against it.
    expect(normal[0] * axis[0] + normal[1] * axis[1] + normal[2] * axis[2]).toBeCloseTo(1, 12);
    expect(seen("probe", pose, ahead, 10).map((one) => Math.abs(one) < 1e-9)).toEqual([true, true]);
  });
});

test.each([
  ["anatomical-axial", "RLAP"],
  ["anatomical-sagittal", "APHF"],
  ["anatomical-coronal", "RLHF"],
] as const)(
  "the %s cut goes through the tip in the patient's directions, as a radiologist sees it",
  (name, edges) => {
    for (const pose of [LEFT, RIGHT]) {
      expect(letters(cutGrid(name, pose, FIELD, 0))).toBe(edges);
      expect(seen(name, pose, pose.tip).map((one) => Math.abs(one) < 1e-9)).toEqual([true, true]);
      expect(beyondMm(cutGrid(name, pose, FIELD, 0), pose.tip)).toBeCloseTo(0, 9);
    }
  },
);

test("a drill along the patient's left keeps a plane: what is up is then the head", () => {
  const grid = cutGrid("axial", { tip: [0, 0, 0], axis: [1, 0, 0] }, FIELD, 0);
  expect(rightOf(grid).map(Math.abs)).toEqual([0, 0, 1]);
});

test("an edge without a direction of the patient within 45 degrees has no letter", () => {
  expect(directionLetter(unit([1, 1, 1]))).toBe("");
  expect(directionLetter(unit([0.1, -1, 0.2]))).toBe("A");
});

test("a stage shows its shorter side whole and nothing distorted, however long it is", () => {
  const { widthMm, heightMm } = fieldOf("axial", 600, 300);
  expect(heightMm).toBeCloseTo(55, 6);
  expect(widthMm / heightMm).toBeCloseTo(2, 9);
  expect(fieldOf("probe", 400, 500).widthMm).toBe(44);
});
