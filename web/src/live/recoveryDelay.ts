// Numbers that were removed for their age are shown again only after a delay: an age close to its limit must
// not make them blink.

const YOUNG_FOR_MS = 250;

export class RecoveryDelay {
  private oldAtMs = -Infinity;

  /** Whether fresh numbers must still be suppressed at `nowMs`. */
  isActive(old: boolean, nowMs: number): boolean {
    if (old) this.oldAtMs = nowMs;
    return nowMs - this.oldAtMs < YOUNG_FOR_MS;
  }
}
