import { expect, test } from "vitest";
import {
  besideProbe,
  choicesOf,
  FIRST_CHOICE,
  hasPlane,
  pairOf,
  switched,
  type TileChoice,
} from "./tileChoice";

const CORONAL: TileChoice = { isAnatomical: true, name: "anatomical-coronal" };

test("the only tile can show the cuts of one kind of planes, the probe's eye and the scene", () => {
  expect(choicesOf(FIRST_CHOICE)).toEqual(["probe", "axial", "sagittal", "scene"]);
  expect(choicesOf(CORONAL)).toEqual([
    "probe",
    "anatomical-axial",
    "anatomical-sagittal",
    "anatomical-coronal",
    "scene",
  ]);
});

test("two tiles show axial above sagittal, until the lower one is to show something else", () => {
  expect(pairOf(FIRST_CHOICE)).toEqual({ upper: "axial", lower: "sagittal", choices: ["sagittal", "scene"] });
  expect(pairOf({ isAnatomical: false, name: "scene" }).lower).toBe("scene");
  expect(pairOf(CORONAL)).toEqual({
    upper: "anatomical-axial",
    lower: "anatomical-coronal",
    choices: ["anatomical-sagittal", "anatomical-coronal", "scene"],
  });
  expect(pairOf({ isAnatomical: true, name: "anatomical-axial" }).lower).toBe("anatomical-sagittal");
});

test("other planes keep the view where they have it", () => {
  const sagittal: TileChoice = { isAnatomical: false, name: "sagittal" };
  expect(switched(sagittal)).toEqual({ isAnatomical: true, name: "anatomical-sagittal" });
  expect(switched(switched(sagittal))).toEqual(sagittal);
  expect(switched(CORONAL)).toEqual({ isAnatomical: false, name: "axial" });
  expect(switched(FIRST_CHOICE)).toEqual({ isAnatomical: true, name: "probe" });
});

test("probe's eye and scene have one plane only", () => {
  expect(hasPlane(CORONAL)).toBe(true);
  expect(hasPlane(FIRST_CHOICE)).toBe(false);
});

test("a single tile beside the probe's eye has the planes and the scene", () => {
  expect(besideProbe(FIRST_CHOICE)).toEqual({ name: "axial", choices: ["axial", "sagittal", "scene"] });
  expect(besideProbe({ isAnatomical: false, name: "scene" }).name).toBe("scene");
  expect(besideProbe(CORONAL).name).toBe("anatomical-coronal");
});
