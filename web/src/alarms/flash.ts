// When an alarm is lit: a function of a monotonic clock, so that all bands flash evenly.
import type { Priority } from "../live/messages";

interface Flash {
  hz: number;
  onRatio: number;
}

/** High 1.4-2.8 Hz, medium 0.4-0.8 Hz, each lit for 20-60 % of the time; low does not flash. */
const FLASH: Record<Priority, Flash | null> = {
  high: { hz: 2, onRatio: 0.5 },
  medium: { hz: 0.6, onRatio: 0.5 },
  low: null,
};

export function isLit(priority: Priority, nowMs: number): boolean {
  const flash = FLASH[priority];
  if (flash === null) return true;
  const periodMs = 1000 / flash.hz;
  return nowMs - Math.floor(nowMs / periodMs) * periodMs < flash.onRatio * periodMs;
}
