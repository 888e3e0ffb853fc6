import { expect, test } from "vitest";
import { formatDuration, formatFigure, formatNumber } from "./rounding";

// The same table applies to `server/number_format.py`, which draws the digits into the video.
test.each([
  [0, "0.0"],
  [-0, "0.0"],
  [-0.04, "0.0"],
  [0.05, "0.1"],
  [0.25, "0.3"],
  [-0.25, "-0.3"],
  [0.35, "0.3"],
  [2.45, "2.5"],
  [1.005, "1.0"],
  [12.34, "12.3"],
  [-12.36, "-12.4"],
  [99.95, "100.0"],
  [Infinity, "--"],
  [NaN, "--"],
  [null, "--"],
])("%d is shown as %s", (value, text) => {
  expect(formatNumber(value)).toBe(text);
});

test("figures have a true minus sign, absence has none", () => {
  expect(formatFigure(-3.21)).toBe("−3.2");
  expect(formatFigure(null)).toBe("--");
});

test.each([
  [-5, "0.0 s"],
  [1240, "1.2 s"],
  [180_000, "3 min"],
])("%d ms lasts %s", (ms, text) => {
  expect(formatDuration(ms)).toBe(text);
});
