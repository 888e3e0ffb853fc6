// Die Alarme auf Deutsch.
import type { Texts } from "./en";

export const alarmsDe: Texts["alarms"] = {
  title: "Alarme",
  none: "Kein Alarm",
  unknown: "ALARME UNBEKANNT: der Server antwortet nicht",
  acknowledge: "Quittieren",
  pause: "Ton 120 s pausieren",
  paused: "Ton pausiert",
  resume: "wieder einschalten",
  failed: "Das kam nicht beim Server an oder wurde nicht protokolliert. Noch einmal versuchen.",
  arm: "TON NICHT BEREIT: hier berühren",
  armFailed: "TON GEHT NICHT: hier berühren, um es noch einmal zu versuchen",
  armed: "Ton bereit",
  over: "VORBEI, NICHT QUITTIERT",
  priority: { high: "HOCH", medium: "MITTEL", low: "NIEDRIG" },
};
