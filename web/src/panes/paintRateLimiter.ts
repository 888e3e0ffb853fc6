// A text that counts up, like an age, is painted a few times a second: each change of it costs an image of the screen.

const EVERY_MS = 100;

export class PaintRateLimiter {
  private key = "";
  private atMs = -Infinity;

  /** Whether to paint now: what is counted has changed, or enough time has passed. */
  isDue(nowMs: number, key: string): boolean {
    if (key === this.key && nowMs - this.atMs < EVERY_MS) return false;
    this.key = key;
    this.atMs = nowMs;
    return true;
  }
}
