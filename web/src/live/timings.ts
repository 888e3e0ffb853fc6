// Durations of the stages of displaying an image: network, decoding, drawing. Pure.

/** Timings of one displayed image. */
export interface ImageTimes {
  /** Time of display. */
  atMs: number;
  /** From sending to reception, without the page's own busy time; null if unknown. */
  networkMs: number | null;
  decodingMs: number;
  /** Painting, including the page's busy time in between. */
  drawingMs: number;
  /** Since capture. */
  ageMs: number;
}

/** Means over the last seconds. */
export interface Timings {
  images: number;
  networkMs: number | null;
  decodingMs: number;
  drawingMs: number;
  ageMs: number;
  /** From the refresh with a picture to the next one: a browser that draws slowly needs longer. */
  screenIntervalMs: number;
}

const WINDOW_MS = 3000;
/** Refresh interval of a usual screen; the excess counts as drawing. */
const SCREEN_INTERVAL_MS = 17;

export class TimingWindow {
  private shown: ImageTimes[] = [];
  private screens: { atMs: number; intervalMs: number }[] = [];

  image(times: ImageTimes): void {
    this.shown.push(times);
    this.shown = this.shown.filter((one) => times.atMs - one.atMs <= WINDOW_MS);
  }

  /** Records how long the screen took for an image. */
  screen(atMs: number, intervalMs: number): void {
    this.screens.push({ atMs, intervalMs });
    this.screens = this.screens.filter((one) => atMs - one.atMs <= WINDOW_MS);
  }

  forget(): void {
    this.shown = [];
    this.screens = [];
  }

  /** Ages of the images since `fromMs`, within the window. */
  agesMs(nowMs: number, fromMs = -Infinity): number[] {
    return this.since(nowMs, fromMs).map((one) => one.ageMs);
  }

  /** Samples since `fromMs`, within the window. */
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

/** What the screen adds to the drawing time. */
export function drawingWithScreenMs({ drawingMs, screenIntervalMs }: Timings): number {
  return drawingMs + Math.max(0, screenIntervalMs - SCREEN_INTERVAL_MS);
}

/** How long the page was too busy to receive: it normally updates at least this often. */
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
