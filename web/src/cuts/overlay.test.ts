import { describe, expect, test } from "vitest";
import { channel } from "../live/builders";
import { planeFromLps } from "../operator/plan/slices/place";
import { unit, type Vec3 } from "../operator/plan/slices/vectors";
import type { Drill } from "./drill";
import { halfAxes95, overlayOf } from "./overlay";
import { cutGrid, type CutName } from "./planes";

const FIELD = { widthMm: 80, heightMm: 100 };
const ENTRY: Vec3 = [14, 12, 0];
/** On the planned axis, 20 mm deep, with a 6.5 x 45 mm screw in an 8 x 40 mm channel. */
const ON_AXIS: Drill = {
  pose: { tip: [14, -8, 0], axis: [0, -1, 0] },
  radiusMm: 2,
  spread: null,
  nearest: null,
};

function drawn(
  name: CutName,
  drill: Drill,
  aheadMm = 0,
): ReturnType<typeof overlayOf> & { entry: readonly [number, number] } {
  const grid = cutGrid(name, drill.pose, FIELD, aheadMm);
  const overlay = overlayOf(name, grid, { channel: channel(), drill, aheadMm, maxOffsetMm: 1.8 });
  return { ...overlay, entry: planeFromLps(grid, ENTRY) };
}

/** Bounds of a path of straight lines relative to a point: left, right, top, bottom. */
function reach(path: string, [x, y]: readonly [number, number]): number[] {
  const places = [...path.matchAll(/(-?[\d.]+) (-?[\d.]+)/g)].map(([, a, b]) => [
    Number(a) - x,
    Number(b) - y,
  ]);
  const [xs, ys] = [places.map(([a = NaN]) => a), places.map(([, b = NaN]) => b)];
  return [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
}

function near(values: number[], wanted: number[]): void {
  expect(values.map((value, n) => Math.abs(value - (wanted[n] ?? NaN)) < 0.1)).toEqual(
    wanted.map(() => true),
  );
}

describe("in a cut along a drill in the planned axis", () => {
  test.each(["axial", "sagittal"] as const)("screw, channel and drill have their true size (%s)", (name) => {
    const { paths, entry } = drawn(name, ON_AXIS);
    // The drilling direction points up.
    near(reach(paths.screw, entry), [-3.25, 3.25, -45, 0]);
    near(reach(paths.channel, entry), [-4, 4, -40, 0]);
    near(reach(paths.shaft, entry).slice(0, 3), [-2, 2, -20]);
  });

  test("there is a tick every 10 mm ahead of the tip", () => {
    const { paths, labels, entry } = drawn("axial", ON_AXIS);
    const ticks = paths.ahead
      .split("M")
      .slice(2)
      .map((one) => reach(one, entry)[2] ?? NaN);
    near(ticks, [-30, -40, -50, -60, -70]);
    expect(labels.map((one) => one.text)).toEqual(["10", "20", "30", "40", "50"]);
  });

  test("a tick whose label would be cut off has none", () => {
    const labelsOf = (heightMm: number): string[] => {
      const grid = cutGrid("axial", ON_AXIS.pose, { widthMm: 80, heightMm }, 0);
      const plan = { channel: channel(), drill: ON_AXIS, aheadMm: 0, maxOffsetMm: 1.8 };
      return overlayOf("axial", grid, plan).labels.map((one) => one.text);
    };
    // The tip is 0.62 of the height below the upper edge.
    expect(labelsOf(52)).toEqual(["10", "20", "30"]);
    expect(labelsOf(51)).toEqual(["10", "20"]);
  });

  test("the cone opens from the tip's ellipse", () => {
    const spread = {
      coneDeg: 2,
      ellipsoidMm: [
        [2.7955, 0, 0],
        [0, 1, 0],
        [0, 0, 1],
      ] as Vec3[],
    };
    const { paths, entry } = drawn("axial", { ...ON_AXIS, spread });
    const widest = 2.4477 + 50 * Math.tan((2 * Math.PI) / 180);
    near(reach(paths.cone, entry), [-widest, widest, -70, -20]);
    near(reach(paths.ellipse, entry).slice(0, 2), [-2.4477, 2.4477]);
  });
});

test("placed screws are drawn where they were placed, also without a drill", () => {
  const placed = (name: string, x: number): ReturnType<typeof channel>["placed_screws"][number] => ({
    name,
    head_in_vertebra_mm: [x, 10, 0],
    tip_in_vertebra_mm: [x, -30, 0],
    diameter_mm: 6,
  });
  const grid = cutGrid("axial", ON_AXIS.pose, FIELD, 0);
  const { paths } = overlayOf("axial", grid, {
    channel: channel({ placed_screws: [placed("L3 left", 15), placed("L3 right", -15)] }),
    drill: null,
    aheadMm: 0,
    maxOffsetMm: null,
  });
  const [left = "", right = ""] = paths.placed.split("Z").filter((one) => one !== "");
  const entry = planeFromLps(grid, ENTRY);
  near(
    reach(left, entry)
      .map(Math.abs)
      .sort((a, b) => a - b),
    [2, 2, 4, 42],
  );
  near(
    reach(right, entry)
      .map(Math.abs)
      .sort((a, b) => a - b),
    [2, 26, 32, 42],
  );
});

describe("the probe's eye", () => {
  /** 3 mm off to one side, 20 mm deep. */
  const beside = (by: Vec3): Drill => ({
    ...ON_AXIS,
    pose: { tip: [14 + by[0], -8 + by[1], by[2]], axis: [0, -1, 0] },
  });

  test("shows the planned axis to the drill's side on which it lies", () => {
    // The drill is 3 mm to the patient's left of the axis. Left is on the left, so the arrow points right.
    const { paths } = drawn("probe", beside([3, 0, 0]));
    const [from, to] = [...paths.off.matchAll(/(-?[\d.]+) (-?[\d.]+)/g)].map(([, x, y]) => [
      Number(x),
      Number(y),
    ]);
    near([(to?.[0] ?? NaN) - (from?.[0] ?? NaN), (to?.[1] ?? NaN) - (from?.[1] ?? NaN)], [3, 0]);
    // And 3 mm towards the feet, so the arrow points up.
    const up = [...drawn("probe", beside([0, 0, -3])).paths.off.matchAll(/(-?[\d.]+) (-?[\d.]+)/g)];
    near([Number(up[1]?.[2]) - Number(up[0]?.[2])], [-3]);
  });

  test("cuts the channel where it is, also by a drill that is not parallel to it", () => {
    const tilted = { ...ON_AXIS, pose: { tip: [14, -8, 0] as Vec3, axis: unit([0.05, -1, 0.02]) } };
    const { paths } = drawn("probe", tilted);
    const [left = NaN, right = NaN, top = NaN, bottom = NaN] = reach(paths.channel, [0, 0]);
    near([right - left, bottom - top], [8, 8]);
  });

  test("beyond the planned end there is no channel, but the rings stay", () => {
    const { paths, labels } = drawn("probe", ON_AXIS, 30);
    expect(paths.channel).toBe("");
    expect(paths.rings).not.toBe("");
    expect(labels.map((one) => one.text)).toEqual(["2", "5"]);
  });

  test("points at a planned axis beyond its border", () => {
    const { paths } = drawn("probe", beside([60, 0, 0]));
    expect(paths.off.split("M")).toHaveLength(3);
  });
});

test("without a drill only the plan is drawn", () => {
  const grid = cutGrid("axial", ON_AXIS.pose, FIELD, 0);
  const { paths } = overlayOf("axial", grid, {
    channel: channel(),
    drill: null,
    aheadMm: 0,
    maxOffsetMm: null,
  });
  expect([paths.shaft, paths.ahead, paths.cone, paths.ring]).toEqual(["", "", "", ""]);
  expect(paths.channel).not.toBe("");
});

test("an ellipse has the half axes of its covariance", () => {
  // Standard deviations 2 and 1 along the diagonals.
  const lengths = halfAxes95([2.5, 1.5, 2.5]).map((half) => Math.hypot(...half));
  near(lengths, [2 * 2.4477, 2.4477]);
});

describe("in an anatomical cut through the tip", () => {
  /** 30 degrees towards the midline in the axial plane. */
  const TILTED: Drill = {
    ...ON_AXIS,
    pose: { tip: [14, -8, 0], axis: unit([-Math.tan(Math.PI / 6), -1, 0]) },
  };

  test("a drill in its plane has its true size, and each tick its true distance", () => {
    const { paths, labels } = drawn("anatomical-axial", TILTED);
    const tip = planeFromLps(cutGrid("anatomical-axial", TILTED.pose, FIELD, 0), TILTED.pose.tip);
    // 4 mm wide at its end, at 30 degrees to the edges: 2 mm times cosine and sine to each side.
    const [left, , top] = reach(paths.shaft, tip);
    near([left ?? NaN, top ?? NaN], [-2 * Math.cos(Math.PI / 6), -2 * Math.sin(Math.PI / 6)]);
    near([reach(paths.ahead, tip)[0] ?? NaN], [-25 - 1.6 * Math.cos(Math.PI / 6)]);
    expect(labels.map((one) => one.text)).toEqual(["10", "20", "30", "40", "50"]);
  });

  test("a drill out of its plane is outlined only where the plane meets it", () => {
    const { paths } = drawn("anatomical-sagittal", TILTED);
    const tip = planeFromLps(cutGrid("anatomical-sagittal", TILTED.pose, FIELD, 0), TILTED.pose.tip);
    // Within its radius of 2 mm over the sine of 30 degrees behind the tip; half of its end lies in front.
    const [left, right, top, bottom] = reach(paths.shaft, tip);
    near([right ?? NaN, top ?? NaN, bottom ?? NaN], [2 / Math.sin(Math.PI / 6), -2, 2]);
    expect(left).toBeGreaterThan(-0.1);
  });

  test("a path that points out of the picture has no ticks that lie on each other", () => {
    const { paths, labels } = drawn("anatomical-coronal", TILTED);
    expect(labels.length).toBe(5);
    const straight = drawn("anatomical-coronal", ON_AXIS);
    expect(straight.labels).toEqual([]);
    expect(paths.ring).not.toBe("");
    expect(straight.paths.ring).not.toBe("");
  });
});
