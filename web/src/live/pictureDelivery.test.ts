import { beforeEach, describe, expect, test } from "vitest";
import { PictureDeliveryMonitor, type PictureDelivery } from "./pictureDelivery";
import type { Timings } from "./timings";

let carrying: PictureDeliveryMonitor;
const SIZE: [number, number] = [1280, 720];
const QUICK: Timings = {
  images: 90,
  networkMs: null,
  decodingMs: 5,
  drawingMs: 1,
  ageMs: 60,
  screenIntervalMs: 17,
};
const ELSEWHERE = { largestPicture: "full", neededRatio: 1, sharesMachine: false } as const;

/** Displays images at this rate for this long; returns the time of the last one. */
function bring(perS: number, seconds: number, scaleRatio = 1, fromMs = 0): number {
  const count = Math.round(perS * seconds);
  for (let i = 0; i < count; i += 1) carrying.recordPicture(fromMs + (i * 1000) / perS, SIZE, scaleRatio);
  return fromMs + ((count - 1) * 1000) / perS;
}

function look(nowMs: number, timings: Partial<Timings> = {}, device: object = {}): PictureDelivery {
  return carrying.update(nowMs, 30, { ...QUICK, ...timings }, { ...ELSEWHERE, ...device });
}

beforeEach(() => {
  carrying = new PictureDeliveryMonitor();
});

test("has no note before the first picture", () => {
  expect(look(1000)).toMatchObject({ widthPx: null, imagesPerS: 0, limitedBy: null });
});

test("a full picture at the camera's rate is not little", () => {
  const seen = look(bring(30, 4));
  expect(seen).toMatchObject({ widthPx: 1280, heightPx: 720, scaleRatio: 1, limitedBy: null });
  expect(seen.imagesPerS).toBeCloseTo(30, 0);
});

test.each<[string, number, number, Partial<Timings>, object, PictureDelivery["limitedBy"]]>([
  ["few images, and nobody knows where they are", 4, 1, {}, {}, "thin"],
  ["few images that are long under way", 4, 1, { networkMs: 200 }, {}, "thin"],
  ["few images that come quickly once they are sent", 4, 1, { networkMs: 5 }, {}, "server"],
  ["few images from a server on this machine", 4, 1, { networkMs: 200 }, { sharesMachine: true }, "server"],
  ["few images that are decoded all the time", 4, 1, { decodingMs: 150, drawingMs: 20 }, {}, "decoding"],
  ["few images that are drawn all the time", 4, 1, { decodingMs: 20, drawingMs: 150 }, {}, "drawing"],
  ["a screen that shows few images", 4, 1, { screenIntervalMs: 180 }, {}, "drawing"],
  [
    "the same where the server is on this machine",
    4,
    1,
    { drawingMs: 150 },
    { sharesMachine: true },
    "drawing",
  ],
  ["a size that the server chose", 28, 0.5, {}, {}, "thin"],
  ["a size that the device asked for", 28, 0.5, { decodingMs: 30 }, { largestPicture: "half" }, "decoding"],
  ["as large as its space needs", 28, 0.5, {}, { neededRatio: 0.5 }, null],
  ["smaller than its space needs", 28, 0.25, {}, { neededRatio: 0.5 }, "thin"],
  ["a smaller one than that", 28, 0.25, { decodingMs: 30 }, { largestPicture: "half" }, "thin"],
])("%s", (_, perS, scaleRatio, timings, device, little) => {
  expect(look(bring(perS, 4, scaleRatio), timings, device).limitedBy).toBe(little);
});

test("a chosen size is called reduced, not a slow connection", () => {
  carrying.choice = "quarter";
  expect(look(bring(30, 4, 0.25))).toMatchObject({ widthPx: 320, heightPx: 180, limitedBy: "reduced" });
});

describe("does not flap", () => {
  test("the note disappears only when clearly enough images arrive", () => {
    let nowMs = bring(10, 4);
    expect(look(nowMs).limitedBy).toBe("thin");
    nowMs = bring(18, 4, 1, nowMs + 100);
    expect(look(nowMs).limitedBy).toBe("thin");
    nowMs = bring(28, 4, 1, nowMs + 100);
    expect(look(nowMs).limitedBy).toBeNull();
  });

  test("one late image is not a thin line", () => {
    expect(look(bring(30, 3) + 200).limitedBy).toBeNull();
  });
});

test("the rate of a stalled connection decreases over time", () => {
  expect(look(bring(30, 3) + 2000).imagesPerS).toBeLessThan(12);
});
