import type { NudgesTexts } from "./nudgesEn";

export const nudgesDe: NudgesTexts = {
  nudges: {
    needsRegistration: "Es gibt keine Registrierung zum Korrigieren. Registrieren Sie zuerst.",
    checkAgain:
      "Jede Korrektur erzeugt eine neue Registrierung: Vor der Navigation an einer Landmarke prüfen.",
    kind: "Verschieben oder drehen",
    shift: "Verschieben",
    turn: "Drehen",
    step: "Schrittweite",
    pad: "Lage des Wirbels korrigieren",
    shiftTo: {
      left: { minus: "nach rechts", plus: "nach links" },
      back: { minus: "nach vorn", plus: "nach hinten" },
      head: { minus: "fußwärts", plus: "kopfwärts" },
    },
    turnTo: {
      left: { minus: "Rückseite fußwärts", plus: "Rückseite kopfwärts" },
      back: { minus: "oberes Ende nach rechts", plus: "oberes Ende nach links" },
      head: { minus: "linke Seite nach vorn", plus: "linke Seite nach hinten" },
    },
    sumMm: "Insgesamt verschoben",
    sumDeg: "Insgesamt gedreht",
    allowed: "erlaubt",
    undo: "Letzte Korrektur zurücknehmen",
    log: "Gültige Korrekturen",
    logEmpty: "Bisher keine Korrektur.",
  },
};
