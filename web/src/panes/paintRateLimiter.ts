// Limits how often a counting text, such as an age, is painted: each change costs a screen refresh, and nobody reads
// digits that change more often.

const EVERY_MS = 250;

export class PaintRateLimiter {
  private key = "";
  private atMs = -Infinity;

  /** True if the content changed or enough time has passed. */
  isDue(nowMs: number, key: string): boolean {
    if (key === this.key && nowMs - this.atMs < EVERY_MS) return false;
    this.key = key;
    this.atMs = nowMs;
    return true;
  }
}
