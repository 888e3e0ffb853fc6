import { expect, test } from "vitest";
import { Showing } from "./showing";
import { drawingWithScreenMs, Stall, TimingWindow } from "./timings";

test("an image's time is split into network, decoding and drawing", () => {
  const showing = new Showing(new Stall(50), 1000);
  showing.decoded(1030);
  showing.stands(1035);
  expect(showing.times(990, 950)).toEqual({
    atMs: 1035,
    networkMs: 10,
    decodingMs: 30,
    drawingMs: 5,
    ageMs: 85,
  });
  expect(showing.pageMs).toBe(35);
});

test("what the page was too busy to hear is drawing, not network nor decoding", () => {
  const stall = new Stall(50);
  stall.tick(900);
  const showing = new Showing(stall, 1010);
  stall.tick(1010);
  showing.decoded(1100);
  showing.stands(1100);
  expect(showing.times(930, 900)).toMatchObject({ networkMs: 20, decodingMs: 50, drawingMs: 100 });
  expect(showing.pageMs).toBe(150);
});

test("before the clocks are compared nobody knows the time on the network", () => {
  expect(new Showing(new Stall(50), 1000).times(null, 950).networkMs).toBeNull();
});

test("means are of the last seconds, and of what came since a change", () => {
  const window = new TimingWindow();
  const image = { networkMs: null, drawingMs: 1, ageMs: 60 };
  window.image({ ...image, atMs: 0, decodingMs: 1000 });
  window.image({ ...image, atMs: 3500, decodingMs: 40 });
  window.image({ ...image, atMs: 4500, decodingMs: 20 });
  for (let atMs = 3000; atMs <= 4500; atMs += 50) window.screen(atMs);
  expect(window.means(4500)).toMatchObject({
    images: 2,
    networkMs: null,
    decodingMs: 30,
    screenIntervalMs: 50,
  });
  expect(window.means(4500, 4000)).toMatchObject({ images: 1, decodingMs: 20 });
  expect(drawingWithScreenMs(window.means(4500))).toBe(34);
});
