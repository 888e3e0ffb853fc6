import type { NudgesTexts } from "./nudgesEn";

export const nudgesDe: NudgesTexts = {
  nudges: {
    needsRegistration: "Es gibt keine Registrierung zum Korrigieren. Registrieren Sie zuerst.",
    checkAgain: "Jede Korrektur ist eine neue Registrierung: vor der Navigation an einem Punkt prüfen.",
    kind: "Schieben oder drehen",
    shift: "Schieben",
    turn: "Drehen",
    step: "Schrittweite",
    pad: "Gezeichneten Wirbel korrigieren",
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
    logEmpty: "Bisher wurde nichts korrigiert.",
  },
};
