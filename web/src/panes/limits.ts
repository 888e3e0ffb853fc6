// The figures as the server assessed them: rounded, and compared with their limits after that. Nothing is
// compared here, so that page, video, alarms and log cannot disagree.
import type { FigureMessage } from "../live/messages";
import type { Reading } from "../live/reading";

export type FigureName = "entry" | "angle" | "depth" | "wall";
export const FIGURES: readonly FigureName[] = ["entry", "angle", "depth", "wall"];

export function figureOf(reading: Reading, name: FigureName): FigureMessage {
  return reading.assessment.figures[name];
}
