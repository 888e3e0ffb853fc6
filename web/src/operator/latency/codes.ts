// Which code the screen shows, and when the next one is due. Pure: times and random numbers go in.

export interface CodePlan {
  patterns: readonly string[];
  codes: number;
  min_code_ms: number;
  max_code_ms: number;
}

export class CodeSequence {
  private painted = 0;
  private dueAtMs = -Infinity;
  /** Since the camera has read one; null while it is being pointed at the screen. */
  private counted: number | null = null;

  constructor(
    private readonly plan: CodePlan,
    private readonly random: () => number,
  ) {}

  /** The code to paint with this screen image; null while the one before it stands, and at the end. */
  next(nowMs: number): number | null {
    if (nowMs < this.dueAtMs || this.isOver) return null;
    const { patterns, min_code_ms, max_code_ms } = this.plan;
    // Random times keep codes and images out of step, so that each part of an image period is met alike.
    this.dueAtMs = nowMs + min_code_ms + this.random() * (max_code_ms - min_code_ms);
    if (this.counted !== null) this.counted += 1;
    return this.painted++ % patterns.length;
  }

  /** The camera has read a code: from here on codes are counted. */
  begin(): void {
    this.counted ??= 0;
  }

  get isCounting(): boolean {
    return this.counted !== null;
  }

  get isOver(): boolean {
    return this.counted !== null && this.counted >= this.plan.codes;
  }

  get doneRatio(): number {
    return (this.counted ?? 0) / this.plan.codes;
  }
}
