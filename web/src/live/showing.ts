// One image on its way from the socket to the page, and where its time goes. Pure: times go in as numbers.
import type { ImageTimes, Stall } from "./timings";

export class Showing {
  private decodedAtMs: number;
  private shownAtMs: number;
  private readonly stallMs: number;
  private decodedStallMs = 0;

  /** It was received just now; what the page was too busy to hear before that is the page's time, too. */
  constructor(
    private readonly stall: Stall,
    private readonly receivedAtMs: number,
  ) {
    this.decodedAtMs = this.shownAtMs = receivedAtMs;
    this.stallMs = stall.overdueMs(receivedAtMs);
  }

  decoded(atMs: number): void {
    this.decodedAtMs = atMs;
    this.decodedStallMs = Math.min(this.stall.overdueMs(atMs), atMs - this.receivedAtMs);
  }

  stands(atMs: number): void {
    this.shownAtMs = atMs;
  }

  /** What the page, and not the network, took for it: the server must not think its line thin for that. */
  get pageMs(): number {
    return Math.max(0, this.shownAtMs - this.receivedAtMs + this.stallMs);
  }

  times(sentAtMs: number | null, capturedAtMs: number): ImageTimes {
    return {
      atMs: this.shownAtMs,
      networkMs: sentAtMs === null ? null : Math.max(0, this.receivedAtMs - sentAtMs - this.stallMs),
      decodingMs: this.decodedAtMs - this.receivedAtMs - this.decodedStallMs,
      drawingMs: this.shownAtMs - this.decodedAtMs + this.decodedStallMs + this.stallMs,
      ageMs: this.shownAtMs - capturedAtMs,
    };
  }
}
