import type { RestTexts } from "./en";

export const restDe: RestTexts = {
  noAnswer: "Der Server antwortet nicht.",
  noAnswerRemedy:
    "Nichts wurde ausgeführt. Prüfen Sie die Verbindung zum Server und versuchen Sie es erneut.",
  loading: "Wird geladen …",
  again: "Erneut versuchen",
  waiting: "wartet",
  cancel: "Abbrechen",
  cancelled: "Abgebrochen. Nichts davon wurde behalten.",
};
