// What the page saw while the latency was measured, by its own clock. Pure: times go in as numbers.
import type { components } from "../../schema";
import type { PaintedImage } from "../../live/view";

export type Conclusion = components["schemas"]["LatencyConclusionRequest"];
type Painted = Conclusion["painted"][number];
type ShownImage = Conclusion["shown"][number];
type Comparison = Conclusion["comparisons"][number];

/** What the server takes. */
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

  /** A picture was drawn; it is seen with the next screen image. */
  draw(image: PaintedImage): void {
    this.drawn.push(image);
  }

  /** A screen image begins: what was drawn before it is shown by it. */
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

  /** A code is painted with the screen image that begins now: the same moment as that of a picture. */
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

  /** Images from before the camera saw a code say nothing; codes stay, because images on their way show them. */
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

  /** Of the screen: the median, because a busy page leaves images of the screen out. */
  private get periodMs(): number {
    const sorted = this.periodsMs.filter((one) => one > 0 && one <= 1000).sort((a, b) => a - b);
    const median = sorted[Math.floor(sorted.length / 2)] ?? USUAL_PERIOD_MS;
    return Math.round(median * 10) / 10;
  }
}
