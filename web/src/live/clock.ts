// The server's monotonic clock as seen from the page, so that time on the line counts as age too.

/** A sample taken over a slower line than this says too little. */
const MAX_ROUND_TRIP_MS = 1000;
/** Of so many samples the quickest counts: on a busy machine others are off by half of their round trip. */
const REMEMBERED = 8;

export class ServerClock {
  private samples: { roundTripMs: number; offsetMs: number }[] = [];

  private get offsetMs(): number | null {
    const first = this.samples[0];
    return first === undefined
      ? null
      : this.samples.reduce((best, one) => (one.roundTripMs <= best.roundTripMs ? one : best), first)
          .offsetMs;
  }

  /** From a question asked at `requestedAtMs` and answered at `answeredAtMs` with the server's `sentAtS`. */
  sample(requestedAtMs: number, answeredAtMs: number, sentAtS: number): void {
    const roundTripMs = answeredAtMs - requestedAtMs;
    if (!(roundTripMs >= 0 && roundTripMs <= MAX_ROUND_TRIP_MS)) return;
    this.samples.push({ roundTripMs, offsetMs: sentAtS * 1000 - (requestedAtMs + answeredAtMs) / 2 });
    if (this.samples.length > REMEMBERED) this.samples.shift();
  }

  /** By how much the server's clock is ahead of the page's; null before the first comparison. */
  get aheadMs(): number | null {
    return this.offsetMs;
  }

  forget(): void {
    this.samples = [];
  }

  /** A moment of the server's clock on the page's; null before the first comparison. */
  pageMs(atS: number): number | null {
    return this.offsetMs === null ? null : atS * 1000 - this.offsetMs;
  }

  /**
   * When an image was grabbed, on the page's clock: the earlier of what the server states (age at sending,
   * counted from receipt) and what the clocks say, so that an image is never taken for younger than it is.
   */
  capturedAtMs(receivedAtMs: number, ageMs: number, capturedAtS: number): number {
    const stated = receivedAtMs - Math.max(ageMs, 0);
    return this.offsetMs === null ? stated : Math.min(stated, capturedAtS * 1000 - this.offsetMs);
  }
}
