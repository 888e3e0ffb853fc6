// What the guiding sound says about one image. Pure.
import type { AlarmsVerdict } from "../alarms/verdict";
import type { NumbersVerdict } from "../live/assess";
import type { DeviationMessage, FigureMessage } from "../live/messages";
import { FIGURES, figureOf, isWithheld } from "../panes/limits";
import type { Reading } from "../live/reading";

/** One note: higher for a larger deviation, heard from the side where the channel is. */
export interface Note {
  hz: number;
  /** -1 left, 1 right. */
  pan: number;
}

/** Outside the bone two notes, for offset and angle; in the bone ticks, faster with less depth to go. */
export type Tone =
  { kind: "align"; offset: Note; angle: Note } | { kind: "drill"; ticksPerS: number; hz: number };

/** A figure within its limit is always heard as this note, as it is always shown in the same colour. */
export const HOME_HZ = { offset: 440, angle: 660 } as const;
const TICK_HZ = 1000;
/** The pitch rises by an octave for each of these, by two at most. */
const OCTAVE = { offset_mm: 10, angle_deg: 10 } as const;
const MAX_OCTAVES = 2;
/** Deviations to one side that are heard from that side alone. */
const FULL_PAN = { offset_mm: 5, angle_deg: 5 } as const;
const TICKS_PER_S = { first: 2, last: 8 } as const;
/** From here on to the planned end the ticks become faster. */
const FASTER_WITHIN_MM = 20;

/** Returns the sound of the newest image, or null where there must be none. */
export function toneOf(numbers: NumbersVerdict, alarms: AlarmsVerdict): Tone | null {
  if (!numbers.live || !isQuiet(alarms)) return null;
  const { reading } = numbers;
  if (FIGURES.some((name) => isWithheld(figureOf(reading, name)))) return null;
  return reading.deviation.depth_mm > 0 ? drilling(reading.deviation) : aligning(reading);
}

/** Never beside an alarm, also not beside a paused one: it might be taken for the alarm, or for its end. */
function isQuiet(alarms: AlarmsVerdict): boolean {
  return (
    alarms.known &&
    alarms.alarms.sound === "silent" &&
    alarms.alarms.alarms.every(({ priority }) => priority === "low")
  );
}

function aligning({ assessment, deviation, along }: Reading): Tone | null {
  const { entry, angle } = assessment.figures;
  const at = along?.at_entry_mm?.[0];
  if (entry.value === null || angle.value === null || along === null || at === undefined) return null;
  const towardsRight = along.medial_is_right ? deviation.transverse_deg : -deviation.transverse_deg;
  return {
    kind: "align",
    offset: noteOf(entry, HOME_HZ.offset, OCTAVE.offset_mm, at / FULL_PAN.offset_mm),
    angle: noteOf(angle, HOME_HZ.angle, OCTAVE.angle_deg, towardsRight / FULL_PAN.angle_deg),
  };
}

/** @param aside deviation to the right in units of the full pan. */
function noteOf({ value, status }: FigureMessage, homeHz: number, octave: number, aside: number): Note {
  if (status === "within") return { hz: homeHz, pan: 0 };
  const octaves = Math.min(Math.abs(value ?? 0) / octave, MAX_OCTAVES);
  return { hz: homeHz * 2 ** octaves, pan: Math.max(-1, Math.min(1, -aside)) };
}

/** Without ticks beyond the planned end: the alarm speaks there. */
function drilling({ remaining_mm: remaining }: DeviationMessage): Tone | null {
  if (remaining <= 0) return null;
  const near = 1 - Math.min(remaining / FASTER_WITHIN_MM, 1);
  const ticksPerS = TICKS_PER_S.first + near * (TICKS_PER_S.last - TICKS_PER_S.first);
  return { kind: "drill", ticksPerS, hz: TICK_HZ };
}
