// Die Alarme auf Deutsch.
import type { Texts } from "./en";

export const alarmsDe: Texts["alarms"] = {
  title: "Alarme",
  none: "Kein Alarm",
  all: "Alle Alarme",
  details: "Details",
  unknown: "ALARME UNBEKANNT: Der Server antwortet nicht",
  acknowledge: "Quittieren",
  pause: "Ton 120\u00a0s pausieren",
  paused: "Ton pausiert",
  resume: "Ton einschalten",
  failed: "Der Server hat dies nicht erhalten oder nicht protokolliert. Erneut versuchen.",
  arm: "TON NICHT BEREIT: hier berühren",
  armFailed: "KEIN TON: für einen neuen Versuch hier berühren",
  armed: "Ton bereit",
  over: "VORBEI, NICHT QUITTIERT",
  priority: { high: "HOCH", medium: "MITTEL", low: "NIEDRIG" },
};
