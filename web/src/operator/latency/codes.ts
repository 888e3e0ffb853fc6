// Sequence of codes and their times. Pure.

interface CodePlan {
  patterns: readonly string[];
  codes: number;
  min_code_ms: number;
  max_code_ms: number;
}

export class CodeSequence {
  private painted = 0;
  private dueAtMs = -Infinity;
  /** Time of the first code that the camera read; null while it is being aimed. */
  private counted: number | null = null;

  constructor(
    private readonly plan: CodePlan,
    private readonly random: () => number,
  ) {}

  /** The code to paint in this refresh; null while the previous one stays, and at the end. */
  next(nowMs: number): number | null {
    if (nowMs < this.dueAtMs || this.isOver) return null;
    const { patterns, min_code_ms, max_code_ms } = this.plan;
    // Random intervals keep codes and images out of step, so that all phases of the image period are sampled.
    this.dueAtMs = nowMs + min_code_ms + this.random() * (max_code_ms - min_code_ms);
    if (this.counted !== null) this.counted += 1;
    return this.painted++ % patterns.length;
  }

  /** The camera has read a code: codes count from now on. */
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
