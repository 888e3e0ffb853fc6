import { beforeEach, expect, test } from "vitest";
import { SceneSwitch } from "./sceneSwitch";
import { TimingWindow } from "./timings";

const LIMIT_MS = 150;
let scene: SceneSwitch;
let window: TimingWindow;
let nowMs: number;

/** An image of this age is displayed now. */
function show(ageMs: number): void {
  window.image({ atMs: nowMs, networkMs: null, decodingMs: 0, drawingMs: 0, ageMs });
}

/** Seconds at 25 images/s in which every n-th image is late. */
function pass(seconds: number, lateEvery: number, limitMs: number | null = LIMIT_MS): void {
  for (let image = 0; image < 25 * seconds; image += 1) {
    nowMs += 40;
    show(image % lateEvery === 0 ? 120 : 60);
    scene.update(nowMs, window, limitMs);
  }
}

beforeEach(() => {
  scene = new SceneSwitch();
  window = new TimingWindow();
  nowMs = 1000;
});

test("stays on while one image in fifty is late", () => {
  pass(60, 50);
  expect(scene.isOn).toBe(true);
});

test("is switched off when one image in ten is late", () => {
  pass(20, 10);
  expect(scene.isOn).toBe(false);
});

test("is not switched off for being slow to load", () => {
  pass(7, 2);
  pass(20, 1000);
  expect(scene.isOn).toBe(true);
});

test("stays on where it does not take the processor of the figures", () => {
  pass(30, 2, null);
  expect(scene.isOn).toBe(true);
});

test("returns only on request, and is switched off again if the figures become late again", () => {
  pass(20, 2);
  pass(60, 1000);
  expect(scene.isOn).toBe(false);
  scene.switchOn(nowMs);
  pass(7, 2);
  expect(scene.isOn).toBe(true);
  pass(7, 2);
  expect(scene.isOn).toBe(false);
});

test("a few images are not judged", () => {
  pass(10, 1000);
  window.forget();
  for (let image = 0; image < 10; image += 1) {
    nowMs += 40;
    show(140);
  }
  scene.update(nowMs, window, LIMIT_MS);
  expect(scene.isOn).toBe(true);
});
