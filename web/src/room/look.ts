// What this page shows, as others are told: the visible pictures, and how old they were in the last second. Pure.
import type { Freshness, Picture, ViewPart } from "../api";
import type { Look } from "./messages";

/** Upper limits of an age: it is reported in steps, since each report is sent to everybody. */
const AGE_STEPS_MS = [100, 200, 500, 1000, 2000, 5000, 10_000];
/** An age goes down a step only if it is clearly below it. */
const STEP_DOWN_RATIO = 0.8;
/** A picture counts if this share of it is on the screen. */
const MIN_VISIBLE_RATIO = 0.25;

const PARTS = new Set<string>([
  "approach",
  "align",
  "drill",
  "overview",
  "figures",
  "case",
  "camera",
  "tool",
  "plan",
  "register",
  "check",
  "navigate",
  "recordings",
  "report",
  "people",
] satisfies ViewPart[]);

export function viewPart(name: string | undefined): ViewPart | null {
  return name !== undefined && PARTS.has(name) ? (name as ViewPart) : null;
}

interface Box {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

/** Pictures that are on the screen, the largest first. */
export function visiblePictures(
  pictures: readonly { name: Picture; box: Box }[],
  screen: { width: number; height: number },
): Picture[] {
  return pictures
    .map(({ name, box }) => {
      const width = Math.min(box.right, screen.width) - Math.max(box.left, 0);
      const height = Math.min(box.bottom, screen.height) - Math.max(box.top, 0);
      const area = Math.max(0, width) * Math.max(0, height);
      return { name, area, whole: (box.right - box.left) * (box.bottom - box.top) };
    })
    .filter(({ area, whole }) => area > 0 && area >= MIN_VISIBLE_RATIO * whole)
    .sort((a, b) => percent(b.area, screen) - percent(a.area, screen))
    .map(({ name }) => name);
}

/** Share of the screen in whole percent: tiles of one size differ by parts of a pixel, and keep their order. */
function percent(area: number, { width, height }: { width: number; height: number }): number {
  return Math.round((100 * area) / (width * height));
}

interface Shown {
  part: ViewPart | null;
  pictures: Picture[];
  isHidden: boolean;
}

/** Collects ages, and returns what is to be reported. */
export class LookReporter {
  private worst: { isLive: boolean; ageMs: number } | null = null;
  private stepMs = 0;
  private reported = "";

  /** Call with each update of the page. */
  add(isLive: boolean, ageMs: number): void {
    const { worst } = this;
    this.worst = { isLive: isLive && worst?.isLive !== false, ageMs: Math.max(ageMs, worst?.ageMs ?? 0) };
  }

  /** Call once a second: the report of the time since the last call; null if it is the same. */
  next(shown: Shown, seat: number): Look | null {
    const look = this.lookOf(shown);
    this.worst = null;
    // A page that has connected again is a new one for the server.
    const key = `${seat} ${JSON.stringify(look)}`;
    if (key === this.reported) return null;
    this.reported = key;
    return look;
  }

  private lookOf({ part, pictures, isHidden }: Shown): Look {
    const isLive = this.worst?.isLive === true;
    const freshness: Freshness = isHidden ? "hidden" : isLive ? "live" : "old";
    if (freshness !== "live" || this.worst === null)
      return { part, pictures: isHidden ? [] : pictures, freshness, max_age_ms: null };
    this.stepMs = stepOf(this.worst.ageMs, this.stepMs);
    return { part, pictures, freshness, max_age_ms: this.stepMs };
  }
}

function stepOf(ageMs: number, beforeMs: number): number {
  const step = AGE_STEPS_MS.find((one) => ageMs <= one) ?? Math.ceil(ageMs / 10_000) * 10_000;
  return step < beforeMs && ageMs > STEP_DOWN_RATIO * step ? beforeMs : step;
}
