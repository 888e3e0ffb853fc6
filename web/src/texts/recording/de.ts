import type { RecordingTexts } from "./en";

export const recordingDe: RecordingTexts = {
  on: "REC",
  off: "keine Aufnahme",
  stopped: "Aufnahme abgebrochen",
  unknown: "Aufnahme: unbekannt",
  lasts: "Platte reicht {time}",
  missing: "{count} Bilder fehlen",
  start: "Aufnehmen",
  stop: "Aufnahme beenden",
  consent: {
    title: "Hat der Patient in die Aufnahme eingewilligt?",
    sentence:
      "Eine Aufnahme enthält Bilder der Operation, Zahlen und Alarme sowie Namen des Personals. Mit der Antwort werden Ihr Name und die Zeit gespeichert.",
    navigating: "Die Aufnahme beginnt mit der Navigation. Ohne Einwilligung wird nichts aufgenommen.",
    yes: "Patient hat eingewilligt",
    no: "Nicht jetzt",
  },
  reasons: {
    RECORDING_DISK_FULL: "die Platte ist voll",
    RECORDING_BUDGET_EXCEEDED: "alle Aufnahmen zusammen sind so groß, wie sie sein dürfen",
    RECORDING_NOT_WRITTEN: "die Platte ließ sich nicht beschreiben",
    RECORDING_PROCESS_ENDED: "ihr Prozess ist beendet",
  },
};
