import type { SetupCheckTexts } from "./en";

export const setupCheckDe: SetupCheckTexts = {
  title: "Geplante Schraube",
  registration:
    "{vertebra} {side}, Schraube von {diameter} mm: Fehler {place} mindestens {error} mm (95 %), {tolerance} mm bis zur Wand.",
  landmarks:
    "{vertebra} {side}, Schraube von {diameter} mm: Mit den geplanten Landmarken, jede auf {sd} mm (1 SD je Achse) genau angetastet, und einem exakten Instrument ist {place} ein Fehler von {error} mm (95 %) zu erwarten, {tolerance} mm bis zur Wand.",
  entry: "am Eintritt",
  isthmus: "am Isthmus",
  suffices: "Der Aufbau reicht für diese Schraube.",
  insufficient: {
    registration: "Der Aufbau reicht nicht: Jedes Bild würde AUFBAU REICHT NICHT melden.",
    landmarks:
      "Das reicht nicht: Bilder würden AUFBAU REICHT NICHT melden, außer wenn genauer angetastet wird als angenommen.",
  },
  remedies: "Jede dieser Maßnahmen hilft für sich:",
  remedy: {
    more_landmarks: "{landmarks} Landmarken, verteilt wie diese, keine verwechselt: {error} mm",
    exact_tool: "Ein Instrument mit exakter Spitze und Achse: {error} mm",
    thinner_screw: "Schraube von {diameter} mm: {tolerance} mm bis zur Wand",
    surface_sweep: "Oberfläche abfahren: Der Fehler ist erst danach bekannt",
  },
  enough: "reicht bestenfalls",
};
