import { expect, test } from "vitest";
import {
  anglesOf,
  besideMm,
  isSame,
  extendChannel,
  lengthMm,
  placeChannel,
  shiftChannel,
  rotateChannel,
  type Draft,
} from "./draft";

/** 40 mm straight forward. */
const DRAFT: Draft = { entry: [15, 20, 5], target: [15, -20, 5], diameterMm: 6 };

test("the whole channel, its entry or its end is moved", () => {
  expect(shiftChannel(DRAFT, "whole", [1, 0, 2])).toMatchObject({ entry: [16, 20, 7], target: [16, -20, 7] });
  expect(shiftChannel(DRAFT, "entry", [1, 0, 2])).toMatchObject({ entry: [16, 20, 7], target: [15, -20, 5] });
  expect(shiftChannel(DRAFT, "target", [1, 0, 2])).toMatchObject({
    entry: [15, 20, 5],
    target: [16, -20, 7],
  });
});

test("its entry, its end or its middle is placed at a point", () => {
  expect(placeChannel(DRAFT, "entry", [1, 2, 3])).toEqual({ ...DRAFT, entry: [1, 2, 3] });
  expect(placeChannel(DRAFT, "target", [1, 2, 3])).toEqual({ ...DRAFT, target: [1, 2, 3] });
  // The middle is at (15, 0, 5).
  expect(placeChannel(DRAFT, "whole", [16, 1, 7])).toEqual({
    ...DRAFT,
    entry: [16, 21, 7],
    target: [16, -19, 7],
  });
});

test("turned about its entry it keeps its length, clockwise on the slice", () => {
  // On an axial slice the patient's left is on the right, seen from the feet; clockwise rotates up to right.
  const turned = rotateChannel(DRAFT, [0, 0, 1], 30);
  expect(turned.entry).toEqual(DRAFT.entry);
  expect(lengthMm(turned)).toBeCloseTo(40, 9);
  expect(turned.target[0]).toBeCloseTo(15 + 20, 9);
  expect(anglesOf(turned, "left").transverseDeg).toBeCloseTo(-30, 9);
  expect(anglesOf(turned, "right").transverseDeg).toBeCloseTo(30, 9);
});

test("to the head the sagittal angle is positive", () => {
  expect(anglesOf({ ...DRAFT, target: [15, -20, 45] }, "left").sagittalDeg).toBeCloseTo(45, 9);
});

test("it grows at its end, and never turns over", () => {
  expect(extendChannel(DRAFT, 5).target).toEqual([15, -25, 5]);
  expect(lengthMm(extendChannel(DRAFT, -99))).toBe(1);
});

test("its ends never come together", () => {
  expect(placeChannel(DRAFT, "entry", DRAFT.target)).toEqual(DRAFT);
});

test("a point beside the axis", () => {
  expect(besideMm(DRAFT, [18, 3, 9])).toBeCloseTo(5, 9);
});

test("a draft that nothing was changed in is the channel", () => {
  const channel = {
    name: "L3 left",
    entry_in_vertebra_mm: [15, 20, 5],
    target_in_vertebra_mm: [15, -20, 5],
    radius_mm: 3,
  } as const;
  expect(isSame(DRAFT, channel)).toBe(true);
  expect(isSame({ ...DRAFT, diameterMm: 6.5 }, channel)).toBe(false);
});
