// The figures as the server assessed them: rounded, then compared with their limits. The page compares nothing, so
// that page, video, alarms and log cannot disagree.
import type { FigureMessage } from "../live/messages";
import type { Reading } from "../live/reading";

export type FigureName = "entry" | "angle" | "depth" | "wall";
export const FIGURES: readonly FigureName[] = ["entry", "angle", "depth", "wall"];

export function figureOf(reading: Reading, name: FigureName): FigureMessage {
  return reading.assessment.figures[name];
}

/** Outside the bone there is no wall; nothing is withheld then. */
export function isWithheld({ value, status }: FigureMessage): boolean {
  return value === null && status !== "outside";
}
