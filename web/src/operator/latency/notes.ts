// Records what the page displayed during the measurement, on its own clock. Pure.
import type { LatencyConclusionRequest } from "../../api";
import type { PaintedImage } from "../../live/view";

type Conclusion = LatencyConclusionRequest;
type Painted = Conclusion["painted"][number];
type ShownImage = Conclusion["shown"][number];
type Comparison = Conclusion["comparisons"][number];

/** Maximum that the server accepts. */
const MAX_PAINTED = 1000;
const MAX_SHOWN = 8000;
const MAX_COMPARISONS = 1000;
const USUAL_PERIOD_MS = 1000 / 60;

export class LatencyNotes {
  private painted: Painted[] = [];
  private shown: ShownImage[] = [];
  private readonly comparisons: Comparison[] = [];
  private readonly periodsMs: number[] = [];
  private drawn: PaintedImage[] = [];
  private frameAtMs: number | null = null;

  /** A picture was drawn; it becomes visible with the next refresh. */
  draw(image: PaintedImage): void {
    this.drawn.push(image);
  }

  /** A refresh begins and shows what was drawn before it. */
  frame(nowMs: number): void {
    if (this.frameAtMs !== null) this.periodsMs.push(nowMs - this.frameAtMs);
    this.frameAtMs = nowMs;
    for (const { message, receivedAtMs } of this.drawn) {
      if (message.snapshot === null) continue;
      this.shown.push({
        image_number: message.snapshot.image_number,
        sent_at_s: message.sent_at_s,
        received_at_ms: receivedAtMs,
        shown_at_ms: nowMs,
      });
    }
    this.drawn = [];
  }

  /** A code is painted in the refresh that begins now, at the same moment as a picture. */
  paint(code: number, nowMs: number): void {
    this.painted.push({ code, painted_at_ms: nowMs });
  }

  compare(requestedAtMs: number, answeredAtMs: number, serverS: number): void {
    this.comparisons.push({
      requested_at_ms: requestedAtMs,
      responded_at_ms: answeredAtMs,
      server_s: serverS,
    });
  }

  /** Removes images from before the first code. Codes are kept, since later images still show them. */
  begin(): void {
    this.shown = [];
  }

  conclusion(madeBy: string, widthPx: number, heightPx: number): Conclusion {
    return {
      made_by: madeBy,
      painted: this.painted.slice(-MAX_PAINTED),
      shown: this.shown.slice(-MAX_SHOWN),
      comparisons: this.comparisons.slice(-MAX_COMPARISONS),
      screen: { width_px: widthPx, height_px: heightPx, period_ms: this.periodMs },
    };
  }

  /** Refresh interval of the screen: the median, since a busy page misses refreshes. */
  private get periodMs(): number {
    const sorted = this.periodsMs.filter((one) => one > 0 && one <= 1000).sort((a, b) => a - b);
    const median = sorted[Math.floor(sorted.length / 2)] ?? USUAL_PERIOD_MS;
    return Math.round(median * 10) / 10;
  }
}
