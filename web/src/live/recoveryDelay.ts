// Prevents figures from blinking when their age crosses the limit repeatedly: after the second time within a second
// they return only when they have been young for a while. A single late image costs no extra time.

const STEADY_AFTER_MS = 1000;
const YOUNG_FOR_MS = 250;

export class RecoveryDelay {
  private wasOld = false;
  private oldAtMs = -Infinity;
  private isRepeated = false;

  /** Whether fresh figures must still be suppressed at `nowMs`. */
  isActive(old: boolean, nowMs: number): boolean {
    if (old && !this.wasOld) this.isRepeated = nowMs - this.oldAtMs < STEADY_AFTER_MS;
    if (old) this.oldAtMs = nowMs;
    this.wasOld = old;
    return this.isRepeated && nowMs - this.oldAtMs < YOUNG_FOR_MS;
  }
}
