import { expect, test } from "vitest";
import { ImageTimer } from "./imageTimer";
import { drawingWithScreenMs, Stall, TimingWindow } from "./timings";

/** An image with these times of reception, decoding and display. */
function shownAt(stall: Stall, receivedAtMs: number, decodedAtMs: number, standsAtMs: number): ImageTimer {
  let nowMs = receivedAtMs;
  const showing = new ImageTimer(() => nowMs, stall, receivedAtMs);
  stall.tick(receivedAtMs);
  nowMs = decodedAtMs;
  showing.markDecoded();
  nowMs = standsAtMs;
  showing.markDisplayed();
  return showing;
}

test("an image's time is split into network, decoding and drawing", () => {
  const showing = shownAt(new Stall(50), 1000, 1030, 1035);
  expect(showing.times(990, 950)).toEqual({
    atMs: 1035,
    networkMs: 10,
    decodingMs: 30,
    drawingMs: 5,
    ageMs: 85,
  });
  expect(showing.deviceMs(990, false)).toBe(35);
  expect(showing.deviceMs(null, true)).toBe(35);
  expect(showing.deviceMs(990, true)).toBe(45);
});

test("what the page was too busy to hear is drawing, not network nor decoding", () => {
  const stall = new Stall(50);
  stall.tick(900);
  const showing = shownAt(stall, 1010, 1100, 1100);
  expect(showing.times(930, 900)).toMatchObject({ networkMs: 20, decodingMs: 50, drawingMs: 100 });
  expect(showing.deviceMs(930, false)).toBe(150);
});

test("before the clock comparison the network time is unknown", () => {
  expect(shownAt(new Stall(50), 1000, 1010, 1011).times(null, 950).networkMs).toBeNull();
});

test("means are of the last seconds, and of what came since a change", () => {
  const window = new TimingWindow();
  const image = { networkMs: null, drawingMs: 1, ageMs: 60 };
  window.image({ ...image, atMs: 0, decodingMs: 1000 });
  window.image({ ...image, atMs: 3500, decodingMs: 40 });
  window.image({ ...image, atMs: 4500, decodingMs: 20 });
  for (let atMs = 3000; atMs <= 4500; atMs += 50) window.screen(atMs, 50);
  expect(window.means(4500)).toMatchObject({
    images: 2,
    networkMs: null,
    decodingMs: 30,
    screenIntervalMs: 50,
  });
  expect(window.means(4500, 4000)).toMatchObject({ images: 1, decodingMs: 20 });
  expect(drawingWithScreenMs(window.means(4500))).toBe(34);
});
