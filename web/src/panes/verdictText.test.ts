import { expect, test } from "vitest";
import { assessment, figure } from "../live/figureBuilders";
import { en } from "../words/en";
import { errorText, riskText, TONE_SYMBOL, wallSide } from "./verdictText";

test("every tone has a shape of its own", () => {
  expect(new Set(Object.values(TONE_SYMBOL)).size).toBe(5);
});

test("the risk of a breach is shown with its limit", () => {
  expect(riskText(assessment(), en)).toBe("Risk of breach: in 2 mm 3 %, screw at the end 4 % · limit 5 %");
});

test("without a pedicle there is no risk to show", () => {
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
