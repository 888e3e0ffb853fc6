import type { SetupCheckTexts } from "./en";

export const setupCheckDe: SetupCheckTexts = {
  title: "Geplante Schraube",
  registration:
    "{vertebra} {side}, Schraube von {diameter} mm: Fehler {place} mindestens {error} mm (95 %), {tolerance} mm bis zur Wand.",
  landmarks:
    "{vertebra} {side}, Schraube von {diameter} mm: Mit den geplanten Landmarken und exaktem Werkzeug ist {place} ein Fehler von {error} mm (95 %) zu erwarten, {tolerance} mm bis zur Wand.",
  entry: "am Eintritt",
  isthmus: "am Isthmus",
  suffices: "Der Aufbau reicht für diese Schraube.",
  insufficient: "Der Aufbau reicht nicht: In jedem Bild hieße es AUFBAU REICHT NICHT.",
  remedies: "Was helfen würde, je für sich:",
  remedy: {
    more_landmarks: "{landmarks} Landmarken, verteilt wie diese und keine verwechselt: {error} mm",
    exact_tool: "Ein Werkzeug mit exakter Spitze und Achse: {error} mm",
    thinner_screw: "Schraube von {diameter} mm: {tolerance} mm bis zur Wand",
    surface_sweep: "Abtasten der Oberfläche: der Fehler ist danach bekannt",
  },
  enough: "reicht bestenfalls",
  notEnough: "reicht nicht",
};
