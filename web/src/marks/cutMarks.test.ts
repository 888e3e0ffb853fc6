import { describe, expect, test } from "vitest";
import { cutGrid, type CutName, type Pose } from "../cuts/planes";
import { lpsFromPlane, type PixelGrid, type Vec2 } from "../operator/plan/slices/place";
import { plus, type Vec3 } from "../operator/plan/slices/vectors";
import type { CutPlane, Point } from "../room/messages";
import { MAX_DISTANCE_MM, outlineOf, patientFrom, placeOn, planeOf, pointOn, strokesOn } from "./cutMarks";
import { DisplayedCut } from "./displayedCut";

const CT = "ct-1";
const POSE: Pose = { tip: [12.3, -45.6, 1100], axis: [0.6, -0.64, 0.48] };
const FIELD = { widthMm: 64, heightMm: 48 };
const STAGE = { width: 640, height: 480 };
const MOMENT = { image_number: 7, captured_at_s: 4 };

function gridAt(name: CutName, tip: Vec3 = POSE.tip): PixelGrid {
  return cutGrid(name, { ...POSE, tip }, FIELD, 0);
}

/** Axial, with its origin in the middle of the cut. */
function axialPlane(): CutPlane {
  return {
    ct_id: CT,
    origin_in_vertebra_mm: [...POSE.tip] as [number, number, number],
    right_in_vertebra: [1, 0, 0],
    down_in_vertebra: [0, 1, 0],
  };
}

describe("a place on a cut", () => {
  test.each(["axial", "sagittal", "probe", "anatomical-coronal"] as const)(
    "of %s is the patient's point, within the rounding",
    (name) => {
      const grid = gridAt(name);
      const plane = planeOf(grid, CT);
      for (const on of [
        [0, 0],
        [63, 47],
        [31.26, 11.04],
      ] as const satisfies Vec2[]) {
        const truth = lpsFromPlane(grid, on);
        const place = placeOn(plane, truth);
        const found = place === null ? null : patientFrom(plane, place);
        if (found === null) throw new Error("no place");
        expect(Math.hypot(...found.map((one, axis) => one - (truth[axis] ?? NaN)))).toBeLessThan(0.08);
      }
    },
  );

  test("is the same point on a stage of another size and field", () => {
    const drawnOn = new DisplayedCut();
    drawnOn.update({ grid: gridAt("axial"), ctId: CT, moment: MOMENT });
    const { surface } = drawnOn;
    if (surface?.plane === undefined) throw new Error("no plane");
    const at = drawnOn.locate([320, 100], STAGE, surface);
    if (at === null) throw new Error("no place");
    const point = patientFrom(surface.plane, at);
    if (point === null) throw new Error("no point");
    // The same plane with a wider field: the place moves, the patient's point does not.
    const wider = cutGrid("axial", POSE, { widthMm: 110, heightMm: 60 }, 0);
    const seen = pointOn(wider, point);
    if (seen === null) throw new Error("not seen");
    const back = lpsFromPlane(wider, seen.at);
    expect(Math.hypot(...back.map((one, axis) => one - (point[axis] ?? NaN)))).toBeLessThan(0.05);
    expect(seen.strength).toBe(1);
  });

  test("beside the cut is clamped, and is nothing for a mark on the video", () => {
    const cut = new DisplayedCut();
    expect(cut.surface).toBeNull();
    cut.update({ grid: gridAt("axial"), ctId: CT, moment: MOMENT });
    const surface = { ...MOMENT, plane: planeOf(gridAt("axial"), CT) };
    expect(cut.isOn([641, 10], STAGE)).toBe(false);
    expect(cut.locate([9999, 0], STAGE, surface)).toEqual(cut.locate([640, 0], STAGE, surface));
    expect(cut.locate([1, 1], STAGE, MOMENT)).toBeNull();
  });
});

describe("a mark in a cut", () => {
  const line: Point[] = [
    [-5, 2],
    [5, 2],
  ];

  test.each([
    [0, 1],
    [0.6, 0.75],
    [1.2, 0.5],
    [-1.9, 0.3],
  ])("whose plane passes at %f mm is drawn with strength %f", (away, strength) => {
    const grid = gridAt("anatomical-axial", plus(POSE.tip, [0, 0, away]));
    const strokes = strokesOn(grid, outlineOf("pen", line, axialPlane()));
    expect(strokes.map((one) => one.strength)).toEqual([strength]);
    const [x, y] = strokes[0]?.points.at(-1) ?? [NaN, NaN];
    // The middle of the top-left pixel is at 31.875, 23.875 mm from the tip.
    expect(x).toBeCloseTo(31.875 + 5, 6);
    expect(y).toBeCloseTo(23.875 + 2, 6);
  });

  test("farther away is not drawn", () => {
    const grid = gridAt("anatomical-axial", plus(POSE.tip, [0, 0, MAX_DISTANCE_MM + 0.1]));
    expect(strokesOn(grid, outlineOf("pen", line, axialPlane()))).toEqual([]);
    expect(strokesOn(grid, outlineOf("pen", [[0, 0]], axialPlane()))).toEqual([]);
  });

  test("of another direction is drawn where it crosses, fainter away from the crossing", () => {
    const strokes = strokesOn(gridAt("anatomical-sagittal"), outlineOf("pen", line, axialPlane()));
    expect(strokes.map((one) => one.strength)).toEqual([0.3, 0.5, 0.75, 1, 0.75, 0.5, 0.3]);
    const places = strokes.flatMap((one) => one.points);
    // Seen from the left the line goes into the picture: it is a point 2 mm behind the tip.
    for (const [x, y] of places) {
      expect(x).toBeCloseTo(31.875 + 2, 6);
      expect(y).toBeCloseTo(23.875, 6);
    }
  });

  test("a circle is round in its own plane", () => {
    const circle = outlineOf(
      "circle",
      [
        [1, 1],
        [1, 6],
      ],
      axialPlane(),
    );
    const [stroke, ...others] = strokesOn(gridAt("anatomical-axial"), circle);
    expect(others).toEqual([]);
    for (const [x, y] of stroke?.points ?? []) expect(Math.hypot(x - 32.875, y - 24.875)).toBeCloseTo(5, 1);
  });

  test("an arrow has its head at its second point", () => {
    const lines = outlineOf("arrow", line, axialPlane());
    expect(lines).toHaveLength(2);
    expect(lines[1]?.[1]).toEqual(plus(POSE.tip, [5, 2, 0]));
  });

  test("of another CT is not drawn, nor one on the video", () => {
    const cut = new DisplayedCut();
    cut.update({ grid: gridAt("anatomical-axial"), ctId: "ct-2", moment: MOMENT });
    const mark = { shape: "pen", points: line } as const;
    expect(cut.drawing({ ...mark, plane: axialPlane() })).toBeNull();
    expect(cut.pointer({ at: [0, 0], plane: axialPlane() })).toBeNull();
    cut.update({ grid: gridAt("anatomical-axial"), ctId: CT, moment: MOMENT });
    expect(cut.drawing({ ...mark, plane: axialPlane() })).not.toBeNull();
    expect(cut.drawing({ ...mark, plane: null })).toBeNull();
  });

  test("stays in the patient when the drill moves", () => {
    const cut = new DisplayedCut();
    let moved = 0;
    cut.onMove(() => (moved += 1));
    const first = gridAt("anatomical-axial");
    cut.update({ grid: first, ctId: CT, moment: MOMENT });
    cut.update({ grid: first, ctId: CT, moment: MOMENT });
    expect(moved).toBe(1);
    const aside = gridAt("anatomical-axial", plus(POSE.tip, [4, 0, 0]));
    const outline = outlineOf("pen", [[0, 0]], axialPlane());
    expect(strokesOn(aside, outline)[0]?.points[0]?.[0]).toBeCloseTo(31.875 - 4, 6);
  });
});
