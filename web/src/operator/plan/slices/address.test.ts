import { expect, test } from "vitest";
import { addressOf, depthOf, neighboursOf, scrolled, type Ct, type Look } from "./address";

const CT = {
  heading: { id: "ct-7" },
  planes: {
    axial: { from_mm: -10, to_mm: 30, step_mm: 2 },
    sagittal: { from_mm: -40, to_mm: 40, step_mm: 0.5 },
    coronal: { from_mm: -50, to_mm: 50, step_mm: 0.5 },
  },
} as unknown as Ct;

const LOOK: Look = {
  cursor: [1.25, -3, 7],
  greys: { window_hu: 1800, level_hu: 400 },
  way: { entry: [15, 14, 2], target: [15, -26, 2] },
  turnDeg: 175,
  depthMm: 12,
};

test("a flat slice is asked for where the cursor is, and of this CT", () => {
  expect(addressOf("sagittal", LOOK, CT)).toBe(
    "/api/ct/slices/sagittal.png?window=1800&level=400&at_mm=1.25#ct-7",
  );
});

test("a cursor beyond the CT shows its last slice", () => {
  expect(addressOf("axial", { ...LOOK, cursor: [0, 0, 99] }, CT)).toContain("at_mm=30#");
});

test("an oblique slice names the channel; without one there is none", () => {
  expect(addressOf("along", LOOK, CT)).toContain("entry=15%2C14%2C2&target=15%2C-26%2C2&view=along");
  expect(addressOf("across", LOOK, CT)).toContain("depth_mm=12");
  expect(addressOf("along", { ...LOOK, way: null }, CT)).toBeNull();
});

test("scrolling follows the scanner's slices and ends at the last", () => {
  // 7 mm is between the slices at 6 and 8 mm.
  expect(scrolled("axial", LOOK, CT, 1).cursor).toEqual([1.25, -3, 10]);
  expect(scrolled("axial", LOOK, CT, -1).cursor).toEqual([1.25, -3, 6]);
  expect(scrolled("axial", LOOK, CT, 99).cursor[2]).toBe(30);
  expect(scrolled("sagittal", LOOK, CT, -2).cursor).toEqual([0.5, -3, 7]);
});

test("scrolling rotates along a channel, and moves in depth across it", () => {
  expect(scrolled("along", LOOK, CT, 2).turnDeg).toBe(-175);
  expect(scrolled("across", LOOK, CT, 3).depthMm).toBe(15);
  expect(depthOf({ entry: [15, 14, 2], target: [15, -26, 2] }, [3, 4, 9])).toBe(10);
});

test("the neighbours are those on both sides, the nearest first", () => {
  const places = neighboursOf("axial", { ...LOOK, cursor: [0, 0, 10] }, CT, 2).map(
    (one) => /at_mm=([-\d.]+)/.exec(one)?.[1],
  );
  expect(places).toEqual(["12", "8", "14", "6"]);
});
