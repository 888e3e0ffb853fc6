// Numbers that went for being old come back only when they have been young for a while: an age that sits on
// its limit must not make them blink.

const YOUNG_FOR_MS = 250;

export class RecoveryDelay {
  private oldAtMs = -Infinity;

  /** Whether what is young at `nowMs` must still be held back. */
  isActive(old: boolean, nowMs: number): boolean {
    if (old) this.oldAtMs = nowMs;
    return nowMs - this.oldAtMs < YOUNG_FOR_MS;
  }
}
