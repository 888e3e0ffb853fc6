import { expect, test } from "vitest";
import { pxInSlice } from "./sliceView";

test("a point is found in a sagittal slice of half-millimetre columns and 2 mm rows", () => {
  // Columns run backwards (y), rows towards the feet (-z); the top-left pixel is at y = -30, z = 50.
  const lpsFromPx = [
    [0, 0, 7],
    [0.5, 0, -30],
    [0, -2, 50],
  ];
  expect(pxInSlice(lpsFromPx, [7, -20, 40])).toEqual([20, 5]);
});
