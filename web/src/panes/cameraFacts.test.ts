import { expect, test } from "vitest";
import { en } from "../texts/en";
import { cameraFacts } from "./cameraFacts";

const MODE = { fourcc: "MJPG", width_px: 1920, height_px: 1080, rate_hz: 30 };
const CAMERA = { clock: "driver" as const, requested: MODE, granted: MODE, controls: {}, note: null };

test("a camera shows the clock of its images and its granted mode", () => {
  expect(cameraFacts(CAMERA, en)).toEqual([
    ["Image time from", "the camera's driver", "image-clock"],
    ["Camera mode", "1920 × 1080 px, MJPG, 30.0 Hz", "camera-mode"],
  ]);
});

test("what is not known of a stream is left out", () => {
  expect(cameraFacts({ ...CAMERA, clock: "arrival", granted: null }, en)).toEqual([
    ["Image time from", "arrival at the server", "image-clock"],
  ]);
  expect(cameraFacts({ ...CAMERA, granted: { ...MODE, fourcc: "", rate_hz: 0 } }, en)[1]).toEqual([
    "Camera mode",
    "1920 × 1080 px",
    "camera-mode",
  ]);
});

test("files have none of it", () => {
  expect(cameraFacts(null, en)).toEqual([]);
});
