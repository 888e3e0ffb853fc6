// Whether the 3-D scene is drawn at all. Drawn by the processor, it takes some 60 ms of a core an image; on a machine of
// two cores that also runs the server, that alone makes the figures too old. It is then switched off before they are,
// and comes back when a person asks for it. Pure: times go in as numbers.
import type { TimingWindow } from "./timings";

/** An image of this age is likely to be too old before the next one replaces it. */
const LATE_RATIO = 0.7;
/** Switched off when more than this share of the images is late. */
const MAX_LATE_SHARE = 0.05;
/** With fewer images in the window there is nothing to judge. */
const MIN_IMAGES = 30;
/** Loading the scene alone makes images late for some seconds. */
const LOADING_MS = 8000;

export class SceneSwitch {
  isOn = true;
  private onSinceMs: number | null = null;

  switchOn(nowMs: number): void {
    this.isOn = true;
    this.onSinceMs = nowMs;
  }

  /** `ageLimitMs` of the figures, where the scene takes their processor; null elsewhere. */
  update(nowMs: number, window: TimingWindow, ageLimitMs: number | null): void {
    this.onSinceMs ??= nowMs;
    if (ageLimitMs === null || !this.isOn) return;
    const agesMs = window.agesMs(nowMs, this.onSinceMs + LOADING_MS);
    const late = agesMs.filter((ageMs) => ageMs > LATE_RATIO * ageLimitMs).length;
    if (agesMs.length >= MIN_IMAGES && late > MAX_LATE_SHARE * agesMs.length) this.isOn = false;
  }
}
