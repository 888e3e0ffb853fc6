// How long each part of showing an image takes: on the network, decoding, drawing. Pure: times go in as numbers.

/** Of one image that is displayed. */
export interface ImageTimes {
  /** When it stood there. */
  atMs: number;
  /** From the server's sending to this page, without the time in which the page itself was busy; null if unknown. */
  networkMs: number | null;
  decodingMs: number;
  /** Painting it, and what the page was busy with while it waited. */
  drawingMs: number;
  /** Since its grab. */
  ageMs: number;
}

/** Means over the last seconds. */
export interface Timings {
  images: number;
  networkMs: number | null;
  decodingMs: number;
  drawingMs: number;
  ageMs: number;
  /** From the screen's image with a picture to its next: a browser that draws slowly needs longer. */
  screenIntervalMs: number;
}

const WINDOW_MS = 3000;
/** A usual screen; what is longer than this is the drawing's. */
const SCREEN_INTERVAL_MS = 17;

export class TimingWindow {
  private shown: ImageTimes[] = [];
  private screens: { atMs: number; intervalMs: number }[] = [];

  image(times: ImageTimes): void {
    this.shown.push(times);
    this.shown = this.shown.filter((one) => times.atMs - one.atMs <= WINDOW_MS);
  }

  /** The screen needed so long for an image. */
  screen(atMs: number, intervalMs: number): void {
    this.screens.push({ atMs, intervalMs });
    this.screens = this.screens.filter((one) => atMs - one.atMs <= WINDOW_MS);
  }

  forget(): void {
    this.shown = [];
    this.screens = [];
  }

  /** The ages of the images that have come since `fromMs`, within the window. */
  agesMs(nowMs: number, fromMs = -Infinity): number[] {
    return this.since(nowMs, fromMs).map((one) => one.ageMs);
  }

  /** Of what has come since `fromMs`, and within the window. */
  means(nowMs: number, fromMs = -Infinity): Timings {
    const from = Math.max(fromMs, nowMs - WINDOW_MS);
    const shown = this.since(nowMs, fromMs);
    const screens = this.screens.filter((one) => one.atMs >= from);
    return {
      images: shown.length,
      networkMs: mean(shown.flatMap(({ networkMs }) => networkMs ?? [])),
      decodingMs: mean(shown.map((one) => one.decodingMs)) ?? 0,
      drawingMs: mean(shown.map((one) => one.drawingMs)) ?? 0,
      ageMs: mean(shown.map((one) => one.ageMs)) ?? 0,
      screenIntervalMs: mean(screens.map((one) => one.intervalMs)) ?? SCREEN_INTERVAL_MS,
    };
  }

  private since(nowMs: number, fromMs: number): ImageTimes[] {
    const from = Math.max(fromMs, nowMs - WINDOW_MS);
    return this.shown.filter((one) => one.atMs >= from);
  }
}

function mean(values: number[]): number | null {
  return values.length === 0 ? null : values.reduce((sum, one) => sum + one, 0) / values.length;
}

/** What the screen adds to the drawing of an image. */
export function drawingWithScreenMs({ drawingMs, screenIntervalMs }: Timings): number {
  return drawingMs + Math.max(0, screenIntervalMs - SCREEN_INTERVAL_MS);
}

/** For how long the page was too busy to hear: it looks around at least this often. */
export class Stall {
  private tickAtMs = -Infinity;

  constructor(private readonly everyMs: number) {}

  tick(nowMs: number): void {
    this.tickAtMs = nowMs;
  }

  overdueMs(nowMs: number): number {
    return Number.isFinite(this.tickAtMs) ? Math.max(0, nowMs - this.tickAtMs - this.everyMs) : 0;
  }
}
