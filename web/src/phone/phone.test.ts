import { expect, test } from "vitest";
import { factsOf, requestedConstraints, withLockedFocus } from "./camera";
import { frameTime } from "./frameTime";
import { noCameraOf, unfit } from "./noCamera";
import { Rate } from "./rate";

const WELCOME = {
  width_px: 1920,
  height_px: 1080,
  rate_hz: 30,
  quality_ratio: 0.9,
  part_bytes: 65536,
  lock_focus: true,
  focus_mm: null,
};
const SIZE = { width: 1920, height: 1080 };

test.each([
  ["the browser knows the capture", 100, 60, { captured_ms: 60, clock: "capture" }],
  ["it does not", 100, undefined, { captured_ms: 100, clock: "presentation" }],
  ["captured after it was presented", 100, 101, { captured_ms: 100, clock: "presentation" }],
  ["captured by another clock", 5000, 60, { captured_ms: 5000, clock: "presentation" }],
])("time of a frame: %s", (_, presentationTime, captureTime, expected) => {
  expect(
    frameTime(captureTime === undefined ? { presentationTime } : { presentationTime, captureTime }),
  ).toEqual(expected);
});

test("asks for the back camera in the server's size, neither scaled nor cut", () => {
  expect(requestedConstraints(WELCOME)).toMatchObject({
    facingMode: { ideal: "environment" },
    width: { ideal: 1920 },
    resizeMode: { ideal: "none" },
  });
});

const RANGE = { focusMode: ["continuous", "manual"], focusDistance: { min: 0.1, max: 2 } };

test.each([
  ["where it has settled", {}, RANGE, 0.42, { focusMode: "manual", focusDistance: 0.42 }],
  ["where it was calibrated", { focus_mm: 500 }, RANGE, 0.42, { focusMode: "manual", focusDistance: 0.5 }],
  ["within what the lens can do", { focus_mm: 50 }, RANGE, 0.42, { focusMode: "manual", focusDistance: 0.1 }],
  ["without a distance", {}, { focusMode: ["manual"] }, undefined, { focusMode: "manual" }],
  ["not, where the browser cannot", {}, { focusMode: ["continuous"] }, undefined, null],
  ["not, where there is no such thing", {}, {}, undefined, null],
  ["not, where the settings leave it alone", { lock_focus: false }, RANGE, 0.42, null],
])("the focus is locked %s", (_, request, capabilities, focusDistance, lock) => {
  const settings = focusDistance === undefined ? {} : { focusDistance };
  const constraints = withLockedFocus({ ...WELCOME, ...request }, capabilities, settings);
  expect(constraints?.advanced?.[0] ?? null).toEqual(lock);
  // Constraints replace each other: without its size the camera would return to its default.
  if (constraints !== null) expect(constraints.width).toEqual({ ideal: 1920 });
});

test.each([
  ["manual", "locked"],
  ["continuous", "automatic"],
  ["single-shot", "automatic"],
  ["none", "unknown"],
  [undefined, "unknown"],
] as const)("a focus mode of %s is %s", (focusMode, focus) => {
  expect(factsOf("", SIZE, focusMode === undefined ? {} : { focusMode }).focus).toBe(focus);
});

test("unknown settings are not invented, and units are the server's", () => {
  expect(factsOf("x".repeat(300), SIZE, {})).toEqual({
    label: "x".repeat(120),
    width_px: 1920,
    height_px: 1080,
    rate_hz: 0,
    focus: "unknown",
    focus_mm: null,
    zoom_percent: null,
  });
  const facts = factsOf("", SIZE, { frameRate: 29.97, focusDistance: 0.4234, zoom: 1.5 });
  expect([facts.rate_hz, facts.focus_mm, facts.zoom_percent]).toEqual([29.97, 423, 150]);
  expect(factsOf("", SIZE, { focusDistance: Infinity, zoom: 0 })).toMatchObject({
    focus_mm: null,
    zoom_percent: null,
  });
});

test.each([
  [false, false, false, "insecure"],
  [true, false, true, "old"],
  [true, true, false, "old"],
  [true, true, true, null],
])("secure %s, cameras %s, frames %s: %s", (isSecure, hasCameras, hasFrames, lacks) => {
  expect(unfit(isSecure, hasCameras, hasFrames)).toBe(lacks);
});

test.each([
  ["NotAllowedError", "denied"],
  ["NotFoundError", "none"],
  ["NotReadableError", "busy"],
  ["TypeError", "other"],
])("%s is reported as %s", (name, expected) => {
  expect(noCameraOf(Object.assign(new Error(), { name }))).toBe(expected);
});

test("a rate is of the last two seconds, and none when nothing went out", () => {
  const rate = new Rate();
  rate.count(0);
  expect(rate.hz(0)).toBe(0);
  rate.count(100);
  expect(rate.hz(100)).toBe(10);
  for (let at = 150; at < 4000; at += 50) rate.count(at);
  expect(rate.hz(3950)).toBe(20);
  expect(rate.hz(6000)).toBe(0);
});
