// What is reduced on a device that is too slow: the 3-D scene's rate, then its size, the rate of the CT cuts, the
// picture's rate, and last the picture's size. Never the numbers. Pure.
import type { Timings } from "./timings";

export interface DrawingBudget {
  /** Shortest interval between images of the 3-D scene; 0 for every screen refresh. */
  sceneIntervalMs: number;
  /** Drawn size of the 3-D scene relative to its displayed size. */
  sceneScale: number;
  /** Shortest interval between CT cuts of a moving drill. */
  cutIntervalMs: number;
  /** Shortest mean interval between pictures; 0 for the next image as soon as one is displayed. */
  pictureIntervalMs: number;
  /** The largest picture that this device can display. */
  largestPicture: "full" | "half";
}

export const UNLIMITED: DrawingBudget = {
  sceneIntervalMs: 0,
  sceneScale: 1,
  cutIntervalMs: 100,
  pictureIntervalMs: 0,
  largestPicture: "full",
};

type Strain = "strained" | "normal" | "idle";

const SCENE_INTERVALS_MS = [0, 80, 125, 200];
/** Below half resolution the letters of the scene would cover it. */
const SCENE_SCALES = [0.7, 0.5];
/** Five images a second, the slowest rate that still looks like motion. */
const FEW_CUTS_INTERVAL_MS = 200;
/** Twenty and sixteen pictures a second. */
const PICTURE_INTERVALS_MS = [50, 62];
/** On a machine shared with the server each picture delays the figures of the next image: down to six a second. */
const SHARED_PICTURE_INTERVALS_MS = [100, 160];
/** Drawn less often than this share of their age limit, a scene, cut or picture would become stale in between. */
const MAX_INTERVAL_RATIO = 0.4;

/** Time until a change has an effect. */
const LOOK_AFTER_MS = 1500;
/** A loading page is slow for a while, so the picture waits longer than the scene. */
const PICTURE_AFTER_MS = 6000;
/** Fewer images than this are not judged. */
const MIN_IMAGES = 4;
const WAIT_MS = 10_000;
const MAX_WAIT_MS = 160_000;
/** A step up that is reverted within this time was a mistake. */
const REGRET_MS = 15_000;

const STRAINED = { showingMs: 40, screenIntervalMs: 40, ageRatio: 0.6 };
const IDLE = { showingMs: 25, screenIntervalMs: 28, ageRatio: 0.5 };
/** Below this rate the picture is made smaller, as the last resort. */
const MIN_IMAGES_PER_S = 12;

/**
 * The steps, best first. A hidden scene cannot be reduced. `sharedPictureStaleAfterMs`: the age limit of pictures if the
 * server shares the machine, else null.
 */
export function budgetSteps(
  staleAfterMs: number,
  isSceneShown: boolean,
  sharedPictureStaleAfterMs: number | null = null,
): DrawingBudget[] {
  const slowestMs = MAX_INTERVAL_RATIO * staleAfterMs;
  const scene = isSceneShown ? sceneSteps(slowestMs) : [UNLIMITED];
  const cutIntervalMs = Math.max(UNLIMITED.cutIntervalMs, Math.min(FEW_CUTS_INTERVAL_MS, slowestMs));
  const fewCuts = { ...(scene.at(-1) ?? UNLIMITED), cutIntervalMs };
  const slowestPictureMs = MAX_INTERVAL_RATIO * (sharedPictureStaleAfterMs ?? 0);
  const shared = SHARED_PICTURE_INTERVALS_MS.filter((ms) => ms <= slowestPictureMs);
  const intervals = [...PICTURE_INTERVALS_MS, ...shared];
  const fewPictures = intervals.map((pictureIntervalMs) => ({ ...fewCuts, pictureIntervalMs }));
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
 * Load of this device in a step. The picture size depends on displaying alone: on a machine shared with the server,
 * the age of images says nothing more about it.
 */
export function strainIn(step: DrawingBudget, timings: Timings, ageLimitMs: number | null): Strain {
  return strainOf(timings, step.largestPicture === "half" ? null : ageLimitMs);
}

/** Load of this device. `ageLimitMs` if the server shares the machine, else null. */
export function strainOf(timings: Timings, ageLimitMs: number | null): Strain {
  const { decodingMs, drawingMs, screenIntervalMs, ageMs } = timings;
  const showingMs = decodingMs + drawingMs;
  const ageRatio = ageLimitMs === null ? 0 : ageMs / ageLimitMs;
  const beyond = (limit: typeof STRAINED): boolean =>
    showingMs > limit.showingMs || screenIntervalMs > limit.screenIntervalMs || ageRatio > limit.ageRatio;
  if (beyond(STRAINED)) return "strained";
  return beyond(IDLE) ? "normal" : "idle";
}

/** Steps down under load, and slowly up again when idle. */
export class BudgetControl {
  private step = 0;
  private changedAtMs = -Infinity;
  /** The last step up, unless it was a mistake. */
  private raisedAtMs: number | null = null;
  private idleSinceMs: number | null = null;
  private waitMs = WAIT_MS;
  isSceneDrawnByProcessor = false;

  /** Without a graphics card the scene starts at its lowest rate and rises if there is capacity. */
  sceneDrawnByProcessor(steps: readonly DrawingBudget[], nowMs: number): void {
    if (this.isSceneDrawnByProcessor) return;
    this.isSceneDrawnByProcessor = true;
    this.slowScene(steps, nowMs);
  }

  /** The scene was shown or hidden; other reductions stay. */
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

  /** Since when this step applies: earlier measurements are ignored. */
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
    // A smaller picture helps only if displaying it takes the time.
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
    // The best interval of software rendering; without a card not every refresh can be reached.
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
