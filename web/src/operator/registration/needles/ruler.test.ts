import { expect, test } from "vitest";
import { viewOfTruth } from "./ruler";

test("a camera 380 mm behind and 240 mm towards the feet of the vertebra is 380 above and 240 beside it", () => {
  // No rotation, so its centre is minus its translation: left 0, back 420, head -240.
  const matrix = [
    [1, 0, 0, 0],
    [0, 1, 0, -420],
    [0, 0, 1, 240],
    [0, 0, 0, 1],
  ];
  expect(viewOfTruth(matrix, [0, 40, 0])).toMatchObject({
    vertical_mm: 380,
    horizontal_mm: 240,
    azimuth_deg: 0,
    patient_end: "feet",
  });
});

test("a camera towards the patient's left has a positive azimuth", () => {
  const matrix = [
    [1, 0, 0, -100],
    [0, 1, 0, -380],
    [0, 0, 1, 100],
    [0, 0, 0, 1],
  ];
  expect(viewOfTruth(matrix, [0, 0, 0]).azimuth_deg).toBe(45);
});
