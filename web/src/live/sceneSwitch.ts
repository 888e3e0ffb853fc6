// Whether the 3-D scene is drawn. Software rendering takes some 60 ms of a core per image; on a two-core machine that
// also runs the server, that alone makes the figures too old. The scene is switched off before that happens, and
// returns on request. Pure.
import type { TimingWindow } from "./timings";

/** An image of this age is likely to become too old before the next one arrives. */
const LATE_RATIO = 0.7;
/** Switched off if more than this share of images is late. */
const MAX_LATE_SHARE = 0.05;
/** Fewer images in the window are not judged. */
const MIN_IMAGES = 30;
/** Loading the scene makes images late for some seconds. */
const LOADING_MS = 8000;

export class SceneSwitch {
  isOn = true;
  private onSinceMs: number | null = null;

  switchOn(nowMs: number): void {
    this.isOn = true;
    this.onSinceMs = nowMs;
  }

  /** Age limit of the figures if the scene shares their processor; null otherwise. */
  update(nowMs: number, window: TimingWindow, ageLimitMs: number | null): void {
    this.onSinceMs ??= nowMs;
    if (ageLimitMs === null || !this.isOn) return;
    const agesMs = window.agesMs(nowMs, this.onSinceMs + LOADING_MS);
    const late = agesMs.filter((ageMs) => ageMs > LATE_RATIO * ageLimitMs).length;
    if (agesMs.length >= MIN_IMAGES && late > MAX_LATE_SHARE * agesMs.length) this.isOn = false;
  }
}
