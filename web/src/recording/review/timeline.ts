// Timeline data of a recording for the curves and the cursor. Pure.
import type { Status } from "../../live/messages";
import { FIGURES } from "../../panes/limits";
import type { TimelineMessage } from "../../api";
import type { CurveName } from "../../trend/curve";
import { MAX_STEP_MS, type Sample, type TrendFigure } from "../../trend/history";
import type { Span } from "./span";

export type Timeline = TimelineMessage;
export type Curves = Timeline["curves"];
export type RecordedEvent = Timeline["events"][number];

export const CURVES: readonly CurveName[] = [...FIGURES, "risk"];

/** Samples per request; a screen has hardly more columns. */
export const MAX_SAMPLES = 1000;

/** Samples of a curve, in ms since the first image; a withheld figure has no value. */
export function samplesOf(curves: Curves): Sample[] {
  return curves.at_s.map((atS, row) => ({
    atMs: 1000 * atS,
    figures: Object.fromEntries(CURVES.map((name) => [name, figureAt(curves, name, row)])) as Record<
      CurveName,
      TrendFigure
    >,
  }));
}

function figureAt(curves: Curves, name: CurveName, row: number): TrendFigure {
  const { values, limits, statuses } = curves[name];
  const status: Status = statuses[row] ?? "unlimited";
  return { value: values[row] ?? null, limit: limits[row] ?? null, status };
}

/** In a long span a sample stands for many images, so samples are further apart. */
export const maxStepMs = ({ fromS, toS }: Span): number =>
  Math.max(MAX_STEP_MS, (2500 * (toS - fromS)) / MAX_SAMPLES);

/** Index of the image at a time, interpolated between samples. */
export function numberAt({ at_s, numbers }: Curves, atS: number, images: number): number {
  let [low, high] = [0, at_s.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if ((at_s[middle] ?? 0) <= atS) low = middle;
    else high = middle;
  }
  const [beforeS, afterS] = [at_s[low] ?? 0, at_s[high] ?? 0];
  const [before, after] = [numbers[low] ?? 0, numbers[high] ?? 0];
  const share = afterS > beforeS ? (atS - beforeS) / (afterS - beforeS) : 0;
  const number = Math.round(before + share * (after - before));
  return Math.min(Math.max(number, 0), Math.max(images - 1, 0));
}

/** Equal notes closer than this are merged: on a slow computer images are missing several times a second. */
const MAX_NOTE_GAP_S = 5;

/** Merges repeated notes into one from the first to the last; other events are unchanged. */
export function mergedNotes(events: readonly RecordedEvent[]): RecordedEvent[] {
  const merged: RecordedEvent[] = [];
  const newest = new Map<string, number>();
  for (const event of events) {
    const at = newest.get(event.code);
    const before = at === undefined ? undefined : merged[at];
    const end = event.to_s ?? event.from_s;
    if (event.kind !== "note") merged.push(event);
    else if (
      at !== undefined &&
      before !== undefined &&
      event.from_s - (before.to_s ?? before.from_s) <= MAX_NOTE_GAP_S
    )
      merged[at] = { ...before, to_s: end };
    else newest.set(event.code, merged.push(event) - 1);
  }
  return merged;
}

/** Assigns events to rows without overlap, earliest first; at least one row. */
export function rowsOf(events: readonly RecordedEvent[]): RecordedEvent[][] {
  const rows: RecordedEvent[][] = [];
  for (const event of events) {
    const free = rows.find((row) => (row.at(-1)?.to_s ?? Infinity) <= event.from_s);
    if (free === undefined) rows.push([event]);
    else free.push(event);
  }
  return rows.length === 0 ? [[]] : rows;
}

/** Whether the event overlaps the span. */
export const isWithin = ({ from_s, to_s }: RecordedEvent, { fromS, toS }: Span): boolean =>
  (to_s ?? from_s) >= fromS && from_s <= toS;
