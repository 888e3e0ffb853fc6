// Figures and headlines for tests, as the server sends them.
import type { AssessmentMessage, FigureMessage, HeadlineMessage } from "./messages";

/** A number as displayed. */
export function figure(value: number | null, changes: Partial<FigureMessage> = {}): FigureMessage {
  return { value, limit: null, error_95: null, status: "within", ...changes };
}

/** Every figure within its limit. */
export function assessment(
  changes: Partial<AssessmentMessage> = {},
  figures: Partial<AssessmentMessage["figures"]> = {},
): AssessmentMessage {
  return {
    kind: "assessment",
    verdict: "on_path",
    figures: {
      entry: figure(1, { limit: 1.8, error_95: 0.7 }),
      angle: figure(2, { limit: 6.3, error_95: 1 }),
      depth: figure(3, { limit: 40, error_95: 0.4 }),
      to_go: figure(37, { limit: 0 }),
      wall: figure(1.8, { limit: 1, error_95: 0.6 }),
      risk: figure(3, { limit: 5 }),
      end: figure(4, { limit: 5 }),
      error: figure(0.8, { limit: 1.8 }),
      ...figures,
    },
    corrections: [],
    wall: "medial",
    end_wall: "medial",
    against: "bone",
    lag: null,
    min_error_95_mm: null,
    ...changes,
  };
}

export function headline(changes: Partial<HeadlineMessage> = {}): HeadlineMessage {
  const none = { en: "", de: "" };
  return {
    verdict: "on_path",
    tone: "good",
    title: { en: "ON PATH", de: "AUF KURS" },
    detail: none,
    event: none,
    ...changes,
  };
}
