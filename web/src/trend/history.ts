// Figures of the last 30 s, for their curves. Pure.
import { isOfNow, type NumbersVerdict } from "../live/assess";
import type { FigureMessage, SnapshotMessage } from "../live/messages";
import { FIGURES, figureOf, type FigureName } from "../panes/limits";

export const SPAN_MS = 30_000;
/** Images within this interval share a sample, the worst of them, so that no peak is lost. */
const BUCKET_MS = 100;
/** Samples further apart are not joined: the values between them are unknown. */
export const MAX_STEP_MS = 700;

export type TrendFigure = Pick<FigureMessage, "value" | "limit" | "status">;

export interface Sample {
  atMs: number;
  /** Null if the figures were withheld; `risk` is known of recordings. */
  figures: (Record<FigureName, TrendFigure> & { risk?: TrendFigure }) | null;
}

export class TrendHistory {
  private readonly buffer: Sample[] = [];
  private newest: SnapshotMessage | null = null;
  private of = "";

  /** Oldest first; at most one per interval. */
  get samples(): readonly Sample[] {
    return this.buffer;
  }

  /** Adds the displayed figures; an image counts once. */
  add(nowMs: number, numbers: NumbersVerdict): void {
    this.drop(nowMs);
    if (!numbers.live) {
      this.addGap(nowMs);
      return;
    }
    if (numbers.snapshot === this.newest) return;
    this.newest = numbers.snapshot;
    // Figures of another plan or tool are not comparable.
    const of = `${numbers.reading.tool} ${JSON.stringify(numbers.snapshot.channel)}`;
    if (of !== this.of) this.buffer.length = 0;
    this.of = of;
    const figures: Record<FigureName, TrendFigure> = {
      entry: figureOf(numbers.reading, "entry"),
      angle: figureOf(numbers.reading, "angle"),
      depth: figureOf(numbers.reading, "depth"),
      wall: figureOf(numbers.reading, "wall"),
    };
    const atMs = nowMs - numbers.ageMs;
    const last = this.buffer.at(-1);
    if (last?.figures != null && atMs - last.atMs < BUCKET_MS) {
      const before = last.figures;
      for (const name of FIGURES) figures[name] = worseOf(name, before[name], figures[name]);
      this.buffer[this.buffer.length - 1] = { atMs: last.atMs, figures };
    } else {
      this.buffer.push({ atMs: Math.max(atMs, last?.atMs ?? -Infinity), figures });
    }
  }

  private addGap(nowMs: number): void {
    const last = this.buffer.at(-1);
    if (last !== undefined && last.figures !== null) this.buffer.push({ atMs: nowMs, figures: null });
  }

  private drop(nowMs: number): void {
    let count = 0;
    // One sample before the span is kept, so that its line enters at the edge.
    while ((this.buffer[count + 1]?.atMs ?? Infinity) < nowMs - SPAN_MS) count += 1;
    if (count > 0) this.buffer.splice(0, count);
  }
}

/** Whether curves may be shown: the newest image is young enough, with figures or a reason for having none. */
export function isTrendShown(numbers: NumbersVerdict): boolean {
  return isOfNow(numbers);
}

/** Returns the worse of two figures; of depths the newer. */
function worseOf(name: FigureName, before: TrendFigure, after: TrendFigure): TrendFigure {
  if (name === "depth" || before.value === null) return after;
  if (after.value === null) return before;
  const isWorse = name === "wall" ? before.value < after.value : before.value > after.value;
  return isWorse ? before : after;
}
