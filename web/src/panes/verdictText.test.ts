import { expect, test } from "vitest";
import type { AssessmentMessage } from "../live/messages";
import { assessment, figure } from "../live/figureBuilders";
import { en } from "../texts/en";
import { errorText, lagText, riskText, TONE_SYMBOL, wallSide } from "./verdictText";

test("every tone has its own symbol", () => {
  expect(new Set(Object.values(TONE_SYMBOL)).size).toBe(5);
});

test("the risk of a breach is shown with its limit", () => {
  expect(riskText(assessment(), en)).toBe("Risk of breach: in 2 mm 3 %, screw at the end 4 % · limit 5 %");
});

test("without a pedicle no risk is shown", () => {
  const none = figure(null, { limit: null, status: "unlimited" });
  expect(riskText(assessment({}, { risk: none, end: none }), en)).toBe("");
  expect(errorText(assessment({}, { error: none }), en)).toBe("95 % error unknown");
});

test("the error is the whole one, with what the pedicle leaves", () => {
  expect(errorText(assessment(), en)).toBe("95 % error ±0.80 mm · limit 1.80 mm");
});

test("the nearest wall is named, and a drill outside has none", () => {
  expect(wallSide(assessment(), en)).toBe("medial");
  const outside = assessment({ wall: null }, { wall: figure(null, { limit: 1, status: "outside" }) });
  expect(wallSide(outside, en)).toBe("outside");
});

test("the lag of a moving tip is shown beside the error, not added to it", () => {
  const lagging = (lag: AssessmentMessage["lag"], source = "camera 0"): string =>
    lagText(assessment({ lag }), source, en);
  expect(lagging(null)).toBe("");
  expect(lagging({ speed_mm_s: 0, latency_ms: 95, margin_mm: 0 })).toBe("");
  expect(lagging({ speed_mm_s: null, latency_ms: 95, margin_mm: null })).toBe("");
  expect(lagging({ speed_mm_s: 40, latency_ms: 95, margin_mm: 3.8 })).toBe(
    "while moving +3.8 mm (40 mm/s × 95 ms)",
  );
  const unknown = { speed_mm_s: 40, latency_ms: null, margin_mm: null };
  expect(lagging(unknown)).toBe("moving: measure the latency in the step Camera");
  expect(lagging(unknown, "rehearsal")).toBe("moving, latency unknown: simulated camera");
});
