// Times the stages of an image: received, decoded, displayed.
import type { ImageTimes, Stall } from "./timings";

export class ImageTimer {
  private decodedAtMs: number;
  private shownAtMs: number;
  private readonly stallMs: number;
  private decodedStallMs = 0;

  /** Starts at reception; an earlier stall of the page counts as the page's time. */
  constructor(
    private readonly now: () => number,
    private readonly stall: Stall,
    private readonly receivedAtMs: number,
  ) {
    this.decodedAtMs = this.shownAtMs = receivedAtMs;
    this.stallMs = stall.overdueMs(receivedAtMs);
  }

  readonly markDecoded = (): void => {
    this.decodedAtMs = this.now();
    this.decodedStallMs = Math.min(
      this.stall.overdueMs(this.decodedAtMs),
      this.decodedAtMs - this.receivedAtMs,
    );
  };

  markDisplayed(): void {
    this.shownAtMs = this.now();
  }

  /**
   * Time that this device, not the network, took: the server must not reduce the picture for it. If the server runs on
   * this machine, there is no network and all time since sending is the machine's.
   */
  deviceMs(sentAtMs: number | null, sharesMachine: boolean): number {
    const lastReceivedAtMs = this.receivedAtMs - this.stallMs;
    const fromMs =
      sharesMachine && sentAtMs !== null ? Math.min(sentAtMs, lastReceivedAtMs) : lastReceivedAtMs;
    return Math.max(0, this.shownAtMs - fromMs);
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
