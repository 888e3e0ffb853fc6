// What this viewer's line carries: how many images a second come, in which size, and whether that is little.
// Pure: times go in as numbers.

export const PICTURE_CHOICES = ["auto", "full", "half", "quarter"] as const;
export type PictureChoice = (typeof PICTURE_CHOICES)[number];

export interface Carried {
  choice: PictureChoice;
  /** Of the newest picture; null before the first. */
  widthPx: number | null;
  heightPx: number | null;
  scaleRatio: number;
  imagesPerS: number;
  /** Why less comes than the camera gives, where it does. */
  little: "thin" | "slow" | "reduced" | null;
}

const WINDOW_MS = 3000;
/** Of the camera's rate: below the first something is said, above the second no more. */
const FEW_RATIO = 0.5;
const ENOUGH_RATIO = 0.7;
/** A page that spends more of its time than this on drawing is itself what is slow. */
const DRAWING_RATIO = 0.6;

interface Arrival {
  atMs: number;
  drawingMs: number;
}

export class Carrying {
  choice: PictureChoice = "auto";
  private arrivals: Arrival[] = [];
  private scaleRatio = 1;
  private sizePx: [number, number] | null = null;
  private fewer = false;

  /** A picture stands on the page: grabbed in this size, sent at this scale, drawn in so long. */
  took(atMs: number, drawingMs: number, sizePx: [number, number], scaleRatio: number): void {
    this.arrivals.push({ atMs, drawingMs });
    this.arrivals = this.arrivals.filter((one) => atMs - one.atMs <= WINDOW_MS);
    this.scaleRatio = scaleRatio;
    this.sizePx = [Math.round(sizePx[0] * scaleRatio), Math.round(sizePx[1] * scaleRatio)];
  }

  forget(): void {
    this.arrivals = [];
    this.fewer = false;
  }

  /** At a camera that gives so many images a second; 0 where that is not known. */
  look(nowMs: number, cameraHz: number): Carried {
    const recent = this.arrivals.filter((one) => nowMs - one.atMs <= WINDOW_MS);
    const imagesPerS = rateOf(recent, nowMs);
    if (imagesPerS < cameraHz * FEW_RATIO) this.fewer = recent.length > 1;
    else if (imagesPerS >= cameraHz * ENOUGH_RATIO) this.fewer = false;
    return {
      choice: this.choice,
      widthPx: this.sizePx?.[0] ?? null,
      heightPx: this.sizePx?.[1] ?? null,
      scaleRatio: this.scaleRatio,
      imagesPerS,
      little: this.little(recent, imagesPerS),
    };
  }

  private little(recent: Arrival[], imagesPerS: number): Carried["little"] {
    const drawingMs = recent.reduce((sum, one) => sum + one.drawingMs, 0) / Math.max(recent.length, 1);
    const isDrawing = (drawingMs * imagesPerS) / 1000 > DRAWING_RATIO;
    if (this.fewer || (this.scaleRatio < 1 && this.choice === "auto")) return isDrawing ? "slow" : "thin";
    return this.scaleRatio < 1 ? "reduced" : null;
  }
}

/** Images a second, counted by the gaps between them; a gap that still lasts counts too. */
function rateOf(recent: Arrival[], nowMs: number): number {
  const [first, last] = [recent[0], recent.at(-1)];
  if (first === undefined || last === undefined || recent.length < 2) return 0;
  const gapMs = (last.atMs - first.atMs) / (recent.length - 1);
  return 1000 / Math.max(gapMs, (nowMs - first.atMs) / recent.length, 1);
}
