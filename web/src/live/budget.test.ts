import { beforeEach, expect, test } from "vitest";
import { BudgetControl, budgetSteps, strainIn, strainOf, UNLIMITED, type DrawingBudget } from "./budget";
import type { Timings } from "./timings";

const STEPS = budgetSteps(500, true);
const IDLE: Timings = {
  images: 30,
  networkMs: 2,
  decodingMs: 8,
  drawingMs: 1,
  ageMs: 60,
  screenIntervalMs: 17,
};
const SLOW: Timings = { ...IDLE, decodingMs: 60, drawingMs: 60 };

let control: BudgetControl;
let nowMs: number;
let steps: DrawingBudget[];
let step: number;

/** Feeds this many seconds of measurements. */
function pass(seconds: number, timings: Timings, ageLimitMs: number | null = null): void {
  for (const until = nowMs + 1000 * seconds; nowMs < until; nowMs += 50) {
    const current = steps[step];
    if (current === undefined) throw new Error("no such step");
    step = control.update(nowMs, steps, timings, strainIn(current, timings, ageLimitMs));
  }
}

beforeEach(() => {
  control = new BudgetControl();
  nowMs = 10_000;
  steps = STEPS;
  step = 0;
});

function stepsTaken(): (DrawingBudget | undefined)[] {
  const seen: (DrawingBudget | undefined)[] = [];
  for (let second = 0; second < 30; second += 1) {
    pass(1, SLOW);
    if (steps[step] !== seen.at(-1)) seen.push(steps[step]);
  }
  return seen;
}

test("gives way in this order: the scene's rate, its size, the cuts, the picture's rate, the picture's size", () => {
  const seen = stepsTaken();
  const smallScene = { ...UNLIMITED, sceneIntervalMs: 200, sceneScale: 0.5 };
  const fewCuts = { ...smallScene, cutIntervalMs: 200 };
  expect(seen).toEqual([
    { ...UNLIMITED, sceneIntervalMs: 80 },
    { ...UNLIMITED, sceneIntervalMs: 125 },
    { ...UNLIMITED, sceneIntervalMs: 200 },
    { ...UNLIMITED, sceneIntervalMs: 200, sceneScale: 0.7 },
    smallScene,
    fewCuts,
    { ...fewCuts, pictureIntervalMs: 50 },
    { ...fewCuts, pictureIntervalMs: 62 },
    { ...fewCuts, pictureIntervalMs: 62, largestPicture: "half" },
  ]);
});

test("where no scene is shown the cuts give way first", () => {
  steps = budgetSteps(500, false);
  const fewCuts = { ...UNLIMITED, cutIntervalMs: 200 };
  expect(stepsTaken()).toEqual([
    fewCuts,
    { ...fewCuts, pictureIntervalMs: 50 },
    { ...fewCuts, pictureIntervalMs: 62 },
    { ...fewCuts, pictureIntervalMs: 62, largestPicture: "half" },
  ]);
  pass(80, IDLE);
  expect(steps[step]).toEqual(UNLIMITED);
});

test("a machine shared with the server shows fewer pictures to keep its figures young", () => {
  steps = budgetSteps(500, false, 500);
  pass(30, { ...IDLE, ageMs: 140 }, 150);
  expect(steps[step]).toMatchObject({ pictureIntervalMs: 160, largestPicture: "full" });
  expect(Math.max(...budgetSteps(500, false).map((one) => one.pictureIntervalMs))).toBe(62);
});

test.each([
  [300, 100],
  [200, 62],
])("with an age limit of %d ms a picture is not older than it before the next one", (limitMs, slowestMs) => {
  const intervals = budgetSteps(500, false, limitMs).map((one) => one.pictureIntervalMs);
  expect(Math.max(...intervals)).toBe(slowestMs);
});

test("a scene that is opened leaves cuts and pictures as they are, and begins at its best", () => {
  const without = (steps = budgetSteps(500, false));
  pass(2, SLOW);
  expect(steps[step]).toEqual({ ...UNLIMITED, cutIntervalMs: 200, pictureIntervalMs: 50 });
  control.setSteps(without, STEPS, nowMs);
  steps = STEPS;
  pass(1, IDLE);
  expect(STEPS[step]).toMatchObject({ cutIntervalMs: 200, pictureIntervalMs: 50 });
});

test("a scene drawn by the processor begins at its slowest rate each time it is opened", () => {
  const without = budgetSteps(500, false);
  control.sceneDrawnByProcessor(STEPS, nowMs);
  control.setSteps(STEPS, without, nowMs);
  control.setSteps(without, STEPS, nowMs);
  pass(1, IDLE);
  expect(STEPS[step]).toMatchObject({ sceneIntervalMs: 200, sceneScale: 1 });
});

test.each([500, 300, 100, 40])(
  "no rate lets the scene go stale between two images, limit %d ms",
  (limitMs) => {
    const ofLimit = budgetSteps(limitMs, true);
    expect(Math.max(...ofLimit.map((one) => one.sceneIntervalMs))).toBeLessThanOrEqual(0.4 * limitMs);
    expect(ofLimit.at(-1)?.largestPicture).toBe("half");
  },
);

test.each<[string, Partial<Timings>, number | null, string]>([
  ["all is quick", {}, null, "idle"],
  ["showing takes long", { decodingMs: 45 }, null, "strained"],
  ["the screen shows few images", { screenIntervalMs: 60 }, null, "strained"],
  ["images are old from a server elsewhere", { ageMs: 140 }, null, "idle"],
  ["images are old from a server on this machine", { ageMs: 140 }, 150, "strained"],
  ["neither well nor badly", { decodingMs: 30 }, null, "normal"],
])("%s", (_, changes, ageLimitMs, strain) => {
  expect(strainOf({ ...IDLE, ...changes }, ageLimitMs)).toBe(strain);
});

test("a scene that is drawn by the processor begins at its slowest rate, and never gets every image", () => {
  control.sceneDrawnByProcessor(STEPS, nowMs);
  pass(1, IDLE);
  expect(STEPS[step]).toMatchObject({ sceneIntervalMs: 200, sceneScale: 1 });
  pass(60, IDLE);
  expect(STEPS[step]).toMatchObject({ sceneIntervalMs: 80, sceneScale: 1 });
});

test("the picture is not made smaller where showing it is not what takes the time", () => {
  pass(60, { ...IDLE, ageMs: 140 }, 150);
  expect(STEPS[step]).toMatchObject({ sceneScale: 0.5, largestPicture: "full" });
});

test("the picture waits longer than the scene before it gets smaller, as while a page is loading", () => {
  pass(11, SLOW);
  expect(STEPS[step]).toMatchObject({ sceneScale: 0.5, largestPicture: "full" });
});

test("the picture returns when displaying is quick, however old the images are", () => {
  pass(30, SLOW);
  expect(STEPS[step]).toMatchObject({ largestPicture: "half" });
  pass(12, { ...IDLE, ageMs: 140 }, 150);
  expect(STEPS[step]).toMatchObject({ sceneScale: 0.5, largestPicture: "full" });
});

test("returns step by step, and later after each failed attempt", () => {
  pass(5, SLOW);
  const low = step;
  pass(12, IDLE);
  expect(step).toBe(low - 1);
  pass(3, SLOW);
  expect(step).toBeGreaterThanOrEqual(low);
  const again = step;
  pass(15, IDLE);
  expect(step).toBe(again);
  pass(8, IDLE);
  expect(step).toBe(again - 1);
});

test("a new step is not judged yet", () => {
  pass(5, { ...SLOW, images: 2 });
  expect(step).toBe(0);
});
