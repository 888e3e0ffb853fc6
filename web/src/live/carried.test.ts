import { beforeEach, describe, expect, test } from "vitest";
import { Carrying } from "./carried";

let carrying: Carrying;
const SIZE: [number, number] = [1280, 720];

/** So many images a second for so long, each drawn in so many ms. */
function bring(perS: number, seconds: number, drawingMs = 5, scaleRatio = 1, fromMs = 0): number {
  const count = Math.round(perS * seconds);
  for (let i = 0; i < count; i += 1) carrying.took(fromMs + (i * 1000) / perS, drawingMs, SIZE, scaleRatio);
  return fromMs + ((count - 1) * 1000) / perS;
}

beforeEach(() => {
  carrying = new Carrying();
});

test("says nothing before the first picture", () => {
  expect(carrying.look(1000, 30)).toMatchObject({ widthPx: null, imagesPerS: 0, little: null });
});

test("a full picture at the camera's rate is not little", () => {
  const nowMs = bring(30, 4);
  const seen = carrying.look(nowMs, 30);
  expect(seen).toMatchObject({ widthPx: 1280, heightPx: 720, scaleRatio: 1, little: null });
  expect(seen.imagesPerS).toBeCloseTo(30, 0);
});

test.each([
  ["few images on a thin line", 4, 5, 1, "thin"],
  ["few images on a device that draws all the time", 4, 200, 1, "slow"],
  ["a size that the server chose", 28, 5, 0.5, "thin"],
] as const)("%s", (_, perS, drawingMs, scaleRatio, little) => {
  const nowMs = bring(perS, 4, drawingMs, scaleRatio);
  expect(carrying.look(nowMs, 30).little).toBe(little);
});

test("a size that the viewer chose is said to be reduced, not thin", () => {
  carrying.choice = "quarter";
  const nowMs = bring(30, 4, 5, 0.25);
  expect(carrying.look(nowMs, 30)).toMatchObject({ widthPx: 320, heightPx: 180, little: "reduced" });
});

describe("does not flap", () => {
  test("few is left only when clearly enough come again", () => {
    let nowMs = bring(10, 4);
    expect(carrying.look(nowMs, 30).little).toBe("thin");
    nowMs = bring(18, 4, 5, 1, nowMs + 100);
    expect(carrying.look(nowMs, 30).little).toBe("thin");
    nowMs = bring(28, 4, 5, 1, nowMs + 100);
    expect(carrying.look(nowMs, 30).little).toBeNull();
  });

  test("one late image is not a thin line", () => {
    const nowMs = bring(30, 3);
    expect(carrying.look(nowMs + 200, 30).little).toBeNull();
  });
});

test("a line that stands still gets slower by itself", () => {
  const nowMs = bring(30, 3);
  expect(carrying.look(nowMs + 2000, 30).imagesPerS).toBeLessThan(12);
});
