import { expect, test } from "vitest";
import type { Status } from "../live/messages";
import type { FigureName } from "../panes/limits";
import { curveOf } from "./curve";
import type { Sample, TrendFigure } from "./history";

const NOW = 100_000;
const SIZE = { nowMs: NOW, width: 300, height: 100 };

function sample(secondsAgo: number, value: number | null, status: Status = "within", limit = 2): Sample {
  const figure: TrendFigure = { value, limit, status };
  return {
    atMs: NOW - 1000 * secondsAgo,
    figures: { entry: figure, angle: figure, depth: figure, wall: figure },
  };
}

const gap = (secondsAgo: number): Sample => ({ atMs: NOW - 1000 * secondsAgo, figures: null });
const xs = (samples: Sample[], name: FigureName = "entry"): number[][] =>
  curveOf(samples, name, SIZE).strokes.map(({ points }) => points.map(([x]) => Math.round(x)));

test("the newest image is on the right, 30 s ago on the left", () => {
  expect(xs([sample(0.5, 1), sample(0, 1)])).toEqual([[295, 300]]);
  expect(xs([sample(30, 1)])).toEqual([[0]]);
});

test("a gap is a gap: nothing is drawn where figures were withheld, or no image came", () => {
  expect(xs([sample(3, 1), sample(2.5, 1), gap(2.4), sample(2.3, 1)])).toEqual([[270, 275], [277]]);
  expect(xs([sample(3, 1), sample(2, 1)])).toEqual([[270], [280]]);
  expect(xs([sample(3, 1), sample(2.5, null), sample(2.2, 1)])).toEqual([[270], [278]]);
});

test("the limit is at half the height, and values beyond the range are clamped", () => {
  const { strokes, limit, range } = curveOf([sample(0.4, 1), sample(0, 3)], "entry", SIZE);
  expect(range).toEqual([-0, 4]);
  expect(strokes[0]?.points.map(([, y]) => y)).toEqual([75, 25]);
  expect(limit).toEqual([
    [
      [296, 50],
      [300, 50],
    ],
  ]);
  const far = curveOf([sample(0, 90)], "entry", SIZE);
  expect(far.range[1]).toBe(8);
  expect(far.strokes[0]?.points[0]?.[1]).toBe(0);
});

test("a clearance has the wall at zero and room below it", () => {
  const { wallY, range, strokes } = curveOf([sample(0, -1, "through", 1)], "wall", SIZE);
  expect(range).toEqual([-1, 3]);
  expect(wallY).toBe(75);
  expect(strokes).toEqual([{ status: "through", points: [[300, 100]] }]);
});

test("a probability is shown from 0 to twice its limit, and up to 100 % without a clamp", () => {
  const rangeAt = (value: number): readonly [number, number] => {
    const risk: TrendFigure = { value, limit: 5, status: "within" };
    const figures = { entry: risk, angle: risk, depth: risk, wall: risk, risk };
    return curveOf([{ atMs: NOW, figures }], "risk", SIZE).range;
  };
  expect(rangeAt(1)).toEqual([-0, 10]);
  expect(rangeAt(100)).toEqual([-0, 100]);
});

test("the way to a worse status has its colour from the last image that was better", () => {
  const samples = [sample(0.6, 1), sample(0.4, 1), sample(0.2, 3, "over"), sample(0, 3, "over")];
  expect(curveOf(samples, "entry", SIZE).strokes.map(({ status }) => status)).toEqual(["within", "over"]);
  expect(xs(samples)).toEqual([
    [294, 296],
    [296, 298, 300],
  ]);
});

test("a figure without a limit has its own range", () => {
  const figure: TrendFigure = { value: 7, limit: null, status: "unlimited" };
  const { range, limit } = curveOf(
    [{ atMs: NOW, figures: { entry: figure, angle: figure, depth: figure, wall: figure } }],
    "angle",
    SIZE,
  );
  expect(range).toEqual([0, 7]);
  expect(limit).toEqual([]);
});
