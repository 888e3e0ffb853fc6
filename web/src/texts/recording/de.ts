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
  reasons: {
    RECORDING_DISK_FULL: "die Platte ist voll",
    RECORDING_BUDGET_EXCEEDED: "alle Aufnahmen zusammen sind so groß, wie sie sein dürfen",
    RECORDING_NOT_WRITTEN: "die Platte ließ sich nicht beschreiben",
    RECORDING_PROCESS_ENDED: "ihr Prozess ist beendet",
  },
};
