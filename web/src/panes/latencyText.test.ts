import { expect, test } from "vitest";
import type { Latency } from "../rest/useLatency";
import { latencyDe } from "../texts/latency/de";
import { latencyEn } from "../texts/latency/en";
import { latencyText } from "./latencyText";

const measured: Latency = {
  measuring: false,
  applies: true,
  result: {
    at: "2026-11-24T11:05:00Z",
    made_by: "ito",
    camera: "camera 0",
    width_px: 1280,
    height_px: 720,
    rate_hz: 30,
    screen: { width_px: 1280, height_px: 800, period_ms: 16.7 },
    report: {
      samples: 152,
      median_ms: 84.4,
      p99_ms: 130.6,
      stage_ms: {},
      image_period_ms: 33.3,
      late_on_average_ms: 16.7,
      clock_error_ms: 0.6,
      images: 610,
      read_images: 598,
      skipped_images: 2,
    },
  },
};

test("the latency is shown in one line with its date", () => {
  expect(latencyText(measured, latencyEn)).toBe("84 ms median, 131 ms p99, measured 2026-11-24");
  expect(latencyText(measured, latencyDe)).toBe("84 ms Median, 131 ms p99, gemessen 2026-11-24");
});

test("a missing measurement is stated", () => {
  expect(latencyText({ measuring: true, result: null, applies: false }, latencyEn)).toBe("not measured");
});

test("a latency of images of another size or rate is not stated", () => {
  expect(latencyText({ ...measured, applies: false }, latencyEn)).toBe(
    "measured with 1280 × 720 px at 30 images/s, the setting is now different: measure again",
  );
});
