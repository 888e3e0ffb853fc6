// What gives way when this device is too slow for everything: the 3-D scene's rate, then its size, the rate of the cuts
// through the CT, the picture's rate, and only then the picture's size. Never the numbers.
// Pure: times go in as numbers.
import type { Timings } from "./timings";

export interface DrawingBudget {
  /** Least time between two images of the 3-D scene; 0 for as often as the screen shows one. */
  sceneIntervalMs: number;
  /** Width and height in which the 3-D scene is drawn, of those in which it is shown. */
  sceneScale: number;
  /** Least time between two cuts of the CT for a drill that moves. */
  cutIntervalMs: number;
  /** Least time from one picture to the next, on average; 0 for the next image as soon as one stands. */
  pictureIntervalMs: number;
  /** The largest picture that this device can show. */
  largestPicture: "full" | "half";
}

export const UNLIMITED: DrawingBudget = {
  sceneIntervalMs: 0,
  sceneScale: 1,
  cutIntervalMs: 100,
  pictureIntervalMs: 0,
  largestPicture: "full",
};

export type Strain = "strained" | "normal" | "idle";

const SCENE_INTERVALS_MS = [0, 80, 125, 200];
/** Letters in the scene keep their pixels: in fewer of them than half they would cover it. */
const SCENE_SCALES = [0.7, 0.5];
/** Five a second: the slowest that still shows a drill's movement as one. */
const FEW_CUTS_INTERVAL_MS = 200;
/** Twenty pictures a second and sixteen: what these take less, a machine that the server shares has for tracking. */
const PICTURE_INTERVALS_MS = [50, 62];
/** A scene or a cut that is drawn more seldom than this share of their limit would be stale in between. */
const MAX_INTERVAL_RATIO = 0.4;

/** A change needs so long to be felt. */
const LOOK_AFTER_MS = 1500;
/** A page that is still loading is slow for a while: the picture waits longer than the scene. */
const PICTURE_AFTER_MS = 6000;
/** With fewer images than this there is nothing to judge. */
const MIN_IMAGES = 4;
const WAIT_MS = 10_000;
const MAX_WAIT_MS = 160_000;
/** A step back up that is taken down again so soon was a mistake. */
const REGRET_MS = 15_000;

const STRAINED = { showingMs: 40, screenIntervalMs: 40, ageRatio: 0.6 };
const IDLE = { showingMs: 25, screenIntervalMs: 28, ageRatio: 0.5 };
/** Below this rate the picture is made smaller, when nothing else is left. */
const MIN_IMAGES_PER_S = 12;

/** The steps, the best first. A scene that is not shown has nothing to give. */
export function budgetSteps(staleAfterMs: number, isSceneShown: boolean): DrawingBudget[] {
  const slowestMs = MAX_INTERVAL_RATIO * staleAfterMs;
  const scene = isSceneShown ? sceneSteps(slowestMs) : [UNLIMITED];
  const cutIntervalMs = Math.max(UNLIMITED.cutIntervalMs, Math.min(FEW_CUTS_INTERVAL_MS, slowestMs));
  const fewCuts = { ...(scene.at(-1) ?? UNLIMITED), cutIntervalMs };
  const fewPictures = PICTURE_INTERVALS_MS.map((pictureIntervalMs) => ({ ...fewCuts, pictureIntervalMs }));
  return [...scene, fewCuts, ...fewPictures, { ...(fewPictures.at(-1) ?? fewCuts), largestPicture: "half" }];
}

function sceneSteps(slowestMs: number): DrawingBudget[] {
  const intervals = SCENE_INTERVALS_MS.filter((ms) => ms <= slowestMs);
  const sceneIntervalMs = intervals.at(-1) ?? 0;
  return [
    ...intervals.map((one) => ({ ...UNLIMITED, sceneIntervalMs: one })),
    ...SCENE_SCALES.map((sceneScale) => ({ ...UNLIMITED, sceneIntervalMs, sceneScale })),
  ];
}

/**
 * How hard this device works in a step. The size of the picture is a matter of showing it alone: how old images are on a
 * machine that the server shares tells of it no more.
 */
export function strainIn(step: DrawingBudget, timings: Timings, ageLimitMs: number | null): Strain {
  return strainOf(timings, step.largestPicture === "half" ? null : ageLimitMs);
}

/** How hard this device works. `ageLimitMs` where the server runs on this very machine and suffers with it, else null. */
export function strainOf(timings: Timings, ageLimitMs: number | null): Strain {
  const { decodingMs, drawingMs, screenIntervalMs, ageMs } = timings;
  const showingMs = decodingMs + drawingMs;
  const ageRatio = ageLimitMs === null ? 0 : ageMs / ageLimitMs;
  const beyond = (limit: typeof STRAINED): boolean =>
    showingMs > limit.showingMs || screenIntervalMs > limit.screenIntervalMs || ageRatio > limit.ageRatio;
  if (beyond(STRAINED)) return "strained";
  return beyond(IDLE) ? "normal" : "idle";
}

/** Steps down while the device is strained, and slowly up again when it is idle. */
export class BudgetControl {
  private step = 0;
  private changedAtMs = -Infinity;
  /** The last step up, unless it is known to have been a mistake. */
  private raisedAtMs: number | null = null;
  private idleSinceMs: number | null = null;
  private waitMs = WAIT_MS;
  isSceneDrawnByProcessor = false;

  /** Without a graphics card the scene begins where it takes the least rate, and rises where there is room. */
  sceneDrawnByProcessor(steps: readonly DrawingBudget[], nowMs: number): void {
    if (this.isSceneDrawnByProcessor) return;
    this.isSceneDrawnByProcessor = true;
    this.slowScene(steps, nowMs);
  }

  /** The scene is shown now, or no more: what else gives way stays as it is. */
  setSteps(from: readonly DrawingBudget[], steps: readonly DrawingBudget[], nowMs: number): void {
    const before = from[this.step] ?? UNLIMITED;
    const same = steps.findIndex(
      (one) =>
        one.cutIntervalMs === before.cutIntervalMs &&
        one.pictureIntervalMs === before.pictureIntervalMs &&
        one.largestPicture === before.largestPicture,
    );
    this.change(Math.max(same, 0), nowMs);
    if (this.isSceneDrawnByProcessor) this.slowScene(steps, nowMs);
  }

  private slowScene(steps: readonly DrawingBudget[], nowMs: number): void {
    const slowest = steps.findLastIndex((one) => one.sceneIntervalMs > 0 && one.sceneScale === 1);
    if (slowest > this.step) this.change(slowest, nowMs);
  }

  /** Since when it is as it is: what was measured before says nothing of it. */
  get sinceMs(): number {
    return this.changedAtMs;
  }

  update(nowMs: number, steps: readonly DrawingBudget[], timings: Timings, strain: Strain): number {
    this.step = Math.min(this.step, steps.length - 1);
    if (strain !== "idle") this.idleSinceMs = null;
    if (timings.images < MIN_IMAGES || nowMs - this.changedAtMs < LOOK_AFTER_MS) return this.step;
    if (strain === "strained" && this.mayFall(steps, timings, nowMs)) this.fall(nowMs);
    else if (strain === "idle") this.rise(steps, nowMs);
    return this.step;
  }

  private mayFall(steps: readonly DrawingBudget[], timings: Timings, nowMs: number): boolean {
    const next = steps[this.step + 1];
    if (next === undefined) return false;
    if (next.largestPicture === "full") return true;
    // A smaller picture helps only where showing it is what takes the time.
    const isShowing = timings.decodingMs + timings.drawingMs > 1000 / MIN_IMAGES_PER_S;
    return isShowing && nowMs - this.changedAtMs >= PICTURE_AFTER_MS;
  }

  private fall(nowMs: number): void {
    const isRegret = this.raisedAtMs !== null && nowMs - this.raisedAtMs <= REGRET_MS;
    if (isRegret) this.waitMs = Math.min(2 * this.waitMs, MAX_WAIT_MS);
    this.raisedAtMs = null;
    this.change(this.step + 1, nowMs);
  }

  private rise(steps: readonly DrawingBudget[], nowMs: number): void {
    this.idleSinceMs ??= nowMs;
    // As often as the processor draws it at best; without a card every image of the screen is out of reach.
    const isEveryImage = steps[1] !== undefined && steps[1].sceneIntervalMs > 0;
    const best = this.isSceneDrawnByProcessor && isEveryImage ? 1 : 0;
    if (this.step <= best || nowMs - this.idleSinceMs < this.waitMs) return;
    if (this.raisedAtMs !== null) this.waitMs = WAIT_MS;
    this.raisedAtMs = nowMs;
    this.change(this.step - 1, nowMs);
  }

  private change(step: number, nowMs: number): void {
    this.step = step;
    this.changedAtMs = nowMs;
    this.idleSinceMs = null;
  }
}
