// The server's monotonic clock as seen from the page, so that transfer time counts as age.

/** Samples with a longer round trip are discarded. */
const MAX_ROUND_TRIP_MS = 1000;
/** The quickest of this many samples counts: on a busy machine the others are off by half of their round trip. */
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

  /** Sample of a request sent at `requestedAtMs` and answered at `answeredAtMs` with the server's `sentAtS`. */
  sample(requestedAtMs: number, answeredAtMs: number, sentAtS: number): void {
    const roundTripMs = answeredAtMs - requestedAtMs;
    if (!(roundTripMs >= 0 && roundTripMs <= MAX_ROUND_TRIP_MS)) return;
    this.samples.push({ roundTripMs, offsetMs: sentAtS * 1000 - (requestedAtMs + answeredAtMs) / 2 });
    if (this.samples.length > REMEMBERED) this.samples.shift();
  }

  /** Offset of the server's clock from the page's; null before the first sample. */
  get aheadMs(): number | null {
    return this.offsetMs;
  }

  forget(): void {
    this.samples = [];
  }

  /** A server time on the page's clock; null before the first sample. */
  pageMs(atS: number): number | null {
    return this.offsetMs === null ? null : atS * 1000 - this.offsetMs;
  }

  /**
   * Capture time of an image on the page's clock: the earlier of the server's statement (age at sending, counted from
   * receipt) and the clock comparison, so that an image never counts as younger than it is.
   */
  capturedAtMs(receivedAtMs: number, ageMs: number, capturedAtS: number): number {
    const stated = receivedAtMs - Math.max(ageMs, 0);
    return this.offsetMs === null ? stated : Math.min(stated, capturedAtS * 1000 - this.offsetMs);
  }
}
