import type { RestTexts } from "./en";

export const restDe: RestTexts = {
  noAnswer: "Der Server antwortet nicht.",
  noAnswerRemedy:
    "Die Anfrage wurde möglicherweise nicht ausgeführt. Prüfen Sie die Verbindung zum Server und versuchen Sie es erneut.",
  loading: "Wird geladen …",
  again: "Erneut versuchen",
  goTo: "Zur Seite {page}",
  waiting: "wartet",
  cancel: "Abbrechen",
  cancelled: "Abgebrochen. Es wurde nichts gespeichert.",
};
