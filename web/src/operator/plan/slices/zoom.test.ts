import { expect, test } from "vitest";
import { moved, planeFromStage, rulerMm, showing, stageFromPlane, whole, zoomedAt } from "./zoom";

const STAGE = { width: 400, height: 300 };
const FRAME = { x: 0, y: 0, width: 100, height: 100 };
const FIT = whole(FRAME, STAGE);

test("the whole slice fits, its middle in the middle", () => {
  expect(FIT).toEqual({ centre: [50, 50], pxPerMm: 3 });
  expect(planeFromStage(FIT, STAGE, [200, 150])).toEqual([50, 50]);
  expect(planeFromStage(FIT, STAGE, [50, 0])).toEqual([0, 0]);
  expect(stageFromPlane(FIT, STAGE, [0, 0])).toEqual([50, 0]);
});

test("a pinch leaves the point under the fingers where it is", () => {
  const before = planeFromStage(FIT, STAGE, [260, 120]);
  const closer = zoomedAt(FIT, STAGE, FRAME, [260, 120], 2);
  expect(closer.pxPerMm).toBe(6);
  expect(planeFromStage(closer, STAGE, [260, 120])).toEqual(before);
});

test.each([
  [1000, 40],
  [0.001, 1.8],
])("zooming by %d ends at %d px/mm", (factor, pxPerMm) => {
  expect(zoomedAt(FIT, STAGE, FRAME, [200, 150], factor).pxPerMm).toBeCloseTo(pxPerMm, 9);
});

test("the slice cannot be pushed out of sight", () => {
  expect(moved(FIT, FRAME, [-30, 60]).centre).toEqual([60, 30]);
  expect(moved(FIT, FRAME, [9999, -9999]).centre).toEqual([0, 100]);
});

test("a hidden point is centred, a visible one moves nothing", () => {
  const close = { centre: [50, 50] as const, pxPerMm: 20 };
  expect(showing(close, STAGE, [52, 51])).toBe(close);
  expect(showing(close, STAGE, [80, 51]).centre).toEqual([80, 51]);
});

test.each([
  [3, 100, 20],
  [5, 100, 20],
  [1, 100, 100],
  [40, 100, 2],
  [0.9, 100, 100],
])("at %d px/mm a ruler of at most %d px is %d mm long", (pxPerMm, maxPx, mm) => {
  expect(rulerMm(pxPerMm, maxPx)).toBe(mm);
});
