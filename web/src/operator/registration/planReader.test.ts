import { expect, test } from "vitest";
import { plannedVertebrae, usedLandmarks } from "./planReader";

test("a plan tells its vertebrae, their channels' sides and their landmarks", () => {
  const plan = {
    vertebrae: [
      {
        name: "L3",
        channels: [{ side: "left" }, { side: "right" }],
        landmarks: [{ name: "left lamina", point_lps_mm: [12, 22, 5] }],
        references: [{ slice_index: 4 }],
      },
      { name: "L4" },
    ],
  };
  expect(plannedVertebrae(plan)).toEqual([
    {
      name: "L3",
      sides: ["left", "right"],
      landmarks: [{ name: "left lamina", pointMm: [12, 22, 5] }],
      hasReference: true,
    },
    { name: "L4", sides: [], landmarks: [], hasReference: false },
  ]);
});

test("only landmarks that were used in the fit count as used", () => {
  const points = [
    { landmark: "left lamina", used: true },
    { landmark: "right lamina", used: false },
  ];
  expect(usedLandmarks({ points })).toEqual(["left lamina"]);
  expect(usedLandmarks({})).toEqual([]);
});
