import { afterEach, expect, test, vi } from "vitest";
import { interpolate } from "../texts/interpolate";
import {
  formatCount,
  formatDuration,
  formatExact,
  formatFigure,
  formatNumber,
  formatPercent,
} from "./rounding";

afterEach(() => {
  vi.unstubAllGlobals();
});

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

test("a German page has decimal commas", () => {
  vi.stubGlobal("document", { documentElement: { lang: "de" } });
  expect(formatNumber(0.8)).toBe("0,8");
  expect(formatNumber(12.345, 2)).toBe("12,35");
  expect(formatNumber(3, 0)).toBe("3");
  expect(formatFigure(-3.21)).toBe("−3,2");
  expect(formatDuration(1240)).toBe("1,2 s");
  expect(formatPercent(0.123)).toBe("12 %");
  expect(formatExact(7.5)).toBe("7,5");
  expect(formatExact(45)).toBe("45");
  expect(formatCount(1_234_567)).toBe("1\u202f234\u202f567");
  expect(interpolate("noch {mm} mm von {name}", { mm: 2.5, name: "v1.2" })).toBe("noch 2,5 mm von v1.2");
});

// Coordinates in SVG, CSS and keys, which machines read.
const OF_MACHINES = [
  "../cuts/CutPane.tsx",
  "../cuts/overlay.ts",
  "../cuts/paintCut.ts",
  "../marks/cutMarks.ts",
  "../operator/plan/slices/projection.ts",
  "../operator/plan/surface/SurfaceDrawing.tsx",
  "../panes/splitText.ts",
  "./rounding.ts",
];

test("nothing else writes decimals in a way of its own", () => {
  const sources = import.meta.glob<string>(["../**/*.{ts,tsx}", "!../api/**", "!../**/*.test.{ts,tsx}"], {
    query: "?raw",
    import: "default",
    eager: true,
  });
  expect(Object.keys(sources).length).toBeGreaterThan(200);
  const found = Object.entries(sources).filter(([, code]) =>
    /toFixed|toPrecision|toLocaleString|NumberFormat/.test(code),
  );
  expect(found.map(([file]) => file).sort()).toEqual(OF_MACHINES);
});
