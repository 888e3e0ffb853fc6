// Which layout the position of the drill asks for. Pure: time is an argument.
import type { NumbersVerdict } from "../../live/assess";
import type { DeviationMessage } from "../../live/messages";
import { FIGURES, figureOf, isWithheld } from "../../panes/limits";
import type { AlarmsVerdict } from "../../alarms/verdict";
import type { Layout } from "./layout";

type Phase = Exclude<Layout, "overview">;
type Place = Pick<DeviationMessage, "depth_mm" | "tip_offset_mm">;

/** Bounds of a phase: the first to enter it, the second to leave it. */
const DRILL_FROM_DEPTH_MM = [2, 0] as const;
const DRILL_WITHIN_MM = [10, 15] as const;
const ALIGN_WITHIN_MM = [20, 30] as const;
/** A phase must last this long before the layout changes. */
const LASTS_MS = 1000;

/** The phase of a drill whose tip is here, with hysteresis towards the layout that is shown. */
export function phaseOf({ depth_mm: depth, tip_offset_mm: offset }: Place, shown: Layout): Phase {
  const isDrilling = shown === "drill" ? 1 : 0;
  if (depth >= DRILL_FROM_DEPTH_MM[isDrilling] && offset <= DRILL_WITHIN_MM[isDrilling]) return "drill";
  const isAtEntry = shown === "align" || shown === "drill" ? 1 : 0;
  return Math.hypot(depth, offset) <= ALIGN_WITHIN_MM[isAtEntry] ? "align" : "approach";
}

interface Moment {
  nowMs: number;
  numbers: NumbersVerdict;
  alarms: AlarmsVerdict;
}

/** Chooses the layout by the drill; never while an alarm is listed or unknown, or a figure is missing. */
export class PhaseDetector {
  private candidate: { phase: Phase; sinceMs: number } | null = null;

  /** Returns the layout to change to, or null. */
  update({ nowMs, numbers, alarms }: Moment, shown: Layout): Phase | null {
    const place = mayChange(numbers, alarms) ? numbers.reading.deviation : null;
    const phase = place === null ? null : phaseOf(place, shown);
    if (phase === null || phase === shown) {
      this.candidate = null;
      return null;
    }
    if (this.candidate?.phase !== phase) this.candidate = { phase, sinceMs: nowMs };
    return nowMs - this.candidate.sinceMs >= LASTS_MS ? phase : null;
  }
}

function mayChange(
  numbers: NumbersVerdict,
  alarms: AlarmsVerdict,
): numbers is Extract<NumbersVerdict, { live: true }> {
  return (
    numbers.live &&
    !FIGURES.some((name) => isWithheld(figureOf(numbers.reading, name))) &&
    alarms.known &&
    alarms.alarms.alarms.length === 0
  );
}
