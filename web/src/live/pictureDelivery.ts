// Picture delivery to this viewer: rate, size, and what limits it. Pure.
import { drawingWithScreenMs, type Timings } from "./timings";

export const PICTURE_CHOICES = ["auto", "full", "half", "quarter"] as const;
export type PictureChoice = (typeof PICTURE_CHOICES)[number];

export interface PictureDelivery {
  choice: PictureChoice;
  /** Size of the newest picture; null before the first. */
  widthPx: number | null;
  heightPx: number | null;
  scaleRatio: number;
  imagesPerS: number;
  /** What limits delivery below the camera's rate and size; null if nothing does. */
  limitedBy: SlowPart | "reduced" | null;
}

/** What holds the images up. */
type SlowPart = "thin" | "server" | "decoding" | "drawing";

/** What this device allows, and its area for the picture. */
interface Device {
  largestPicture: "full" | "half";
  /** Scale that suffices for the picture's area. */
  neededRatio: number;
  sharesMachine: boolean;
}

const WINDOW_MS = 3000;
/** Shares of the camera's rate: a note appears below the first and disappears above the second. */
const FEW_RATIO = 0.5;
const ENOUGH_RATIO = 0.7;
/** A page that spends more than this share of its time on displaying images is itself slow. */
const SHOWING_RATIO = 0.5;
/** Share of the idle time; if less of it is network, the server takes the rest. */
const NETWORK_RATIO = 0.5;

export class PictureDeliveryMonitor {
  choice: PictureChoice = "auto";
  private arrivedAtMs: number[] = [];
  private scaleRatio = 1;
  private sizePx: [number, number] | null = null;
  private fewer = false;

  /** Records a displayed picture: its capture size, and the scale it was sent at. */
  recordPicture(atMs: number, sizePx: [number, number], scaleRatio: number): void {
    this.arrivedAtMs = [...this.arrivedAtMs.filter((one) => atMs - one <= WINDOW_MS), atMs];
    this.scaleRatio = scaleRatio;
    this.sizePx = [Math.round(sizePx[0] * scaleRatio), Math.round(sizePx[1] * scaleRatio)];
  }

  forget(): void {
    this.arrivedAtMs = [];
    this.fewer = false;
  }

  /** Result for a camera with this rate; 0 if unknown. */
  update(nowMs: number, cameraHz: number, timings: Timings, device: Device): PictureDelivery {
    const recent = this.arrivedAtMs.filter((atMs) => nowMs - atMs <= WINDOW_MS);
    const imagesPerS = rateOf(recent, nowMs);
    if (imagesPerS < cameraHz * FEW_RATIO) this.fewer = recent.length > 1;
    else if (imagesPerS >= cameraHz * ENOUGH_RATIO) this.fewer = false;
    return {
      choice: this.choice,
      widthPx: this.sizePx?.[0] ?? null,
      heightPx: this.sizePx?.[1] ?? null,
      scaleRatio: this.scaleRatio,
      imagesPerS,
      limitedBy: this.limitation(imagesPerS, timings, device),
    };
  }

  private limitation(imagesPerS: number, timings: Timings, device: Device): PictureDelivery["limitedBy"] {
    const isSmall = this.scaleRatio < device.neededRatio;
    // The server reduces the picture only for the connection; a size that this page requested is this device's limit.
    const isOwn = isSmall && device.largestPicture === "half" && this.scaleRatio >= 0.5;
    if (this.choice === "auto" && isSmall) return isOwn ? slowerOf(timings) : "thin";
    if (this.fewer) return slowPart(imagesPerS, timings, device);
    return isSmall ? "reduced" : null;
  }
}

function slowPart(imagesPerS: number, timings: Timings, { sharesMachine }: Device): SlowPart {
  const betweenMs = 1000 / Math.max(imagesPerS, 1);
  const showingMs = timings.decodingMs + drawingWithScreenMs(timings);
  if (showingMs > SHOWING_RATIO * betweenMs) return slowerOf(timings);
  const { networkMs } = timings;
  const isQuick = networkMs !== null && networkMs < NETWORK_RATIO * (betweenMs - showingMs);
  return sharesMachine || isQuick ? "server" : "thin";
}

function slowerOf(timings: Timings): "decoding" | "drawing" {
  return timings.decodingMs > drawingWithScreenMs(timings) ? "decoding" : "drawing";
}

/** Images per second from the gaps between them, including the present gap. */
function rateOf(recent: number[], nowMs: number): number {
  const [first, last] = [recent[0], recent.at(-1)];
  if (first === undefined || last === undefined || recent.length < 2) return 0;
  const gapMs = (last - first) / (recent.length - 1);
  return 1000 / Math.max(gapMs, (nowMs - first) / recent.length, 1);
}
