import type { CheckTexts } from "./en";

export const checkDe: CheckTexts = {
  title: "Prüfung an einer Landmarke",
  needsRegistration: "Es gibt keine gültige Registrierung, die geprüft werden könnte.",
  choose: "Landmarke wählen",
  why: "Die Spitze auf eine Landmarke halten, die nicht zur Registrierung diente. Die Spitze darf höchstens {max} mm von deren geplantem Ort entfernt sein.",
  wasUsed: "für die Registrierung verwendet",
  noneFree:
    "Alle Landmarken wurden verwendet. Eine auslassen und neu registrieren, oder in der Planung eine weitere setzen.",
  begin: "Spitze liegt an: prüfen",
  byEye: "Die Spitze auf die Landmarke am Knochen halten. Der Abstand erscheint nach der Messung.",
  keep: "Prüfung speichern",
  keepFailed: "Als nicht bestanden speichern",
  again: "Neu antasten",
  other: "Andere Landmarke",
  passed: "BESTANDEN",
  failed: "NICHT BESTANDEN",
  distance: "Abstand und Grenzwert",
  allowed: "erlaubt",
  off: "Die Spitze liegt",
  left: "links",
  right: "rechts",
  back: "hinten",
  front: "vorn",
  head: "kopfwärts",
  feet: "fußwärts",
  sure: "Auf ±{sd} mm bekannt, aus {images} Bildern.",
  failedRemedy:
    "Neu antasten, falls die Spitze abgerutscht ist. Sonst neu registrieren: Mit dieser Registrierung ist keine Navigation möglich.",
  every: "Erforderlich alle {minutes} min, höchstens {max} mm.",
  dueIn: "Nächste Prüfung fällig in {minutes} min.",
  lastFailed:
    "Die letzte Prüfung wurde nicht bestanden: Die Navigation bleibt gesperrt, bis eine bestanden ist.",
  dueNow: "Die Prüfung ist wieder fällig. Die Navigation läuft weiter.",
};
