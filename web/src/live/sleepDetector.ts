// Whether the computer slept, during which the clock of all ages on the page stands still in some browsers. Pure.

/** Far more than two readings of the clocks are apart, and less than any age that is shown as live. */
const MIN_SLEEP_MS = 100;

export class SleepDetector {
  private offsetMs: number;

  constructor(
    /** Time of day. */
    private readonly wallMs: () => number,
    /** The clock of all ages. */
    private readonly awakeMs: () => number,
  ) {
    this.offsetMs = this.readOffsetMs();
  }

  /** Whether it slept since the last call. Setting the time of day looks the same, and costs one reconnection. */
  hasSlept(): boolean {
    const before = this.offsetMs;
    this.offsetMs = this.readOffsetMs();
    return Math.abs(this.offsetMs - before) > MIN_SLEEP_MS;
  }

  private readOffsetMs(): number {
    return this.wallMs() - this.awakeMs();
  }
}
