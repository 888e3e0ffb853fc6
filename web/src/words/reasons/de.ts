// Why there is no picture, no number, no marker.
import type { Words } from "../shape";

export const reasonsDe: Pick<Words, "cause" | "absent" | "unseen"> = {
  cause: {
    hidden: {
      state: "SEITE WAR VERDECKT",
      sentence: "Sobald sie sichtbar ist, zeigt sie wieder, was live ist.",
    },
    connecting: { state: "VERBINDET", sentence: "Wartet auf das erste Wort vom Server." },
    "server-gone": { state: "SERVER WEG", sentence: "Keine Antwort vom Server. Neuer Versuch von selbst." },
    "process-starting": {
      state: "STARTET",
      sentence: "Die Verfolgung wird gestartet. Das dauert einige Sekunden.",
    },
    "process-restarting": {
      state: "STARTET NEU",
      sentence: "Die Verfolgung blieb stehen und wird neu gestartet.",
    },
    "process-given_up": {
      state: "VERFOLGUNG STEHT",
      sentence: "Die Verfolgung ist zu oft ausgefallen. Siehe Meldung.",
    },
    "source-opening": { state: "KAMERA WIRD GEÖFFNET", sentence: "Die Kamera wird geöffnet." },
    "source-reconnecting": {
      state: "KAMERA VERLOREN",
      sentence: "Es kommen keine Bilder. Neuer Versuch von selbst.",
    },
    "source-ended": { state: "ENDE DES VIDEOS", sentence: "Das Video ist bis zum Ende gespielt." },
    "no-image": { state: "WARTET", sentence: "Noch kein Bild." },
    old: { state: "ZU ALT", sentence: "Das Letzte ist zu alt, um gezeigt zu werden." },
  },
  absent: {
    MARKER_UNSEEN: {
      state: "MARKER NICHT GESEHEN",
      sentence: "Den Marker ins Sichtfeld der Kamera bringen.",
    },
    CAMERA_NOT_CALIBRATED: {
      state: "KAMERA NICHT KALIBRIERT",
      sentence: "Mit einer Kameradatei starten (--camera): ohne sie sind keine Millimeter bekannt.",
    },
    POSE_UNCERTAIN: { state: "LAGE UNSICHER", sentence: "Den Marker näher, ruhiger, schräger zeigen." },
    TOOL_NOT_DEFINED: {
      state: "WERKZEUG NICHT BESTIMMT",
      sentence: "In config.yaml (tools) angeben, wo die Bohrerspitze hinter ihrem Marker liegt.",
    },
    NOT_REGISTERED: {
      state: "NICHT REGISTRIERT",
      sentence: "Plan und Patient kennen einander nicht: bitte registrieren.",
    },
    NO_PLAN: {
      state: "KEIN PLAN",
      sentence: "Es gibt keinen geplanten Kanal: im CT planen.",
    },
    REFERENCE_UNSEEN: {
      state: "PATIENT NICHT GESEHEN",
      sentence: "Der Marker am Patienten wird nicht gesehen. Sicht freimachen oder abwischen.",
    },
    CAMERA_MOVED: {
      state: "KAMERA BEWEGT",
      sentence: "Die Kamera steht anders als bei der Registrierung. Neu registrieren.",
    },
    REFERENCE_MOVED: {
      state: "PATIENT BEWEGT",
      sentence:
        "Der Patient oder sein Marker hat sich bewegt. An einer Landmarke prüfen oder neu registrieren.",
    },
    POSE_JUMPED: {
      state: "POSE GESPRUNGEN",
      sentence: "Der Bohrer scheint weiter bewegt, als eine Hand kann. Kurz ruhig halten.",
    },
    NOT_CHECKED: {
      state: "NICHT GEPRÜFT",
      sentence: "Registriert, aber noch nicht an einer Landmarke geprüft. Zum Prüfen eine berühren.",
    },
    NOT_CONFIRMED: {
      state: "NAVIGATION ANGEHALTEN",
      sentence: "Neu gestartet. Erst bestätigt der Bediener, dass sich nichts bewegt hat.",
    },
    NOT_COSIGNED: {
      state: "NICHT GEGENGEZEICHNET",
      sentence: "Planung oder Registrierung wartet auf die Unterschrift einer zweiten Person.",
    },
  },
  unseen: {
    NO_CANDIDATE: "nichts im Bild sieht ihm ähnlich",
    SCORE_TOO_LOW: "zu wenige seiner Kanten sind da",
    TARGET_SCORE_TOO_LOW: "Kanten, die er nicht hat",
    SHAPE_DIFFERS: "innen eine andere Form: ein Doppelgänger",
  },
};
