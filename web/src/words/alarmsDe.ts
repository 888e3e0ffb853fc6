// Die Alarme auf Deutsch.
import type { Words } from "./en";

export const alarmsDe: Words["alarms"] = {
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
  over: "es ist vorbei",
  limit: "Grenze",
  acknowledgedBy: "quittiert von",
  priority: { high: "HOCH", medium: "MITTEL", low: "NIEDRIG" },
  conditions: {
    BREACH: {
      state: "WAND DURCHBROCHEN",
      sentence: "Der Bohrer ist durch die Wand des Pedikels",
      remedy: "Anhalten und den Bohrer zurückziehen.",
    },
    PAST_DEPTH: {
      state: "ZU TIEF",
      sentence: "Die Spitze ist hinter dem geplanten Ende",
      remedy: "Anhalten und den Bohrer zurückziehen.",
    },
    BREACH_LIKELY: {
      state: "DURCHBRUCH WAHRSCHEINLICH",
      sentence: "Wahrscheinlichkeit, durch die Wand zu sein",
      remedy: "Anhalten und den Bohrer ruhig in voller Sicht der Kamera halten.",
    },
    CLEARANCE_LOW: {
      state: "NAHE DER WAND",
      sentence: "Knochen, der neben dem Bohrer bleibt",
      remedy: "Den Bohrer zurück zur Kanalachse drehen.",
    },
    DRILL_UNSEEN: {
      state: "BOHRER NICHT GESEHEN",
      sentence: "Sein Marker ist nicht zu sehen",
      remedy: "Den Marker ins Bild bringen; quittieren, wenn der Bohrer weggelegt ist.",
    },
    REFERENCE_UNSEEN: {
      state: "PATIENT NICHT GESEHEN",
      sentence: "Der Marker am Patienten ist nicht zu sehen",
      remedy: "Die Sicht auf den Marker am Patienten freimachen.",
    },
    CAMERA_STALLED: {
      state: "KEIN BILD",
      sentence: "Es kam kein Bild",
      remedy: "Warten; das Kabel der Kamera prüfen.",
    },
    CAMERA_GONE: {
      state: "KAMERA WEG",
      sentence: "Von der Kamera kommen keine Bilder",
      remedy: "Kamera und Kabel prüfen; neuer Versuch von selbst.",
    },
    POSE_UNCERTAIN: {
      state: "LAGE UNSICHER",
      sentence: "Die Spitze ist für diesen Pedikel nicht sicher genug",
      remedy: "Den Marker näher, ruhiger, schräger zeigen.",
    },
    POSE_JUMPED: {
      state: "LAGE NICHT EINDEUTIG",
      sentence: "Zwei Lagen erklären das Bild, oder sie ist gesprungen",
      remedy: "Den Bohrer still halten und seinen Marker zur Kamera neigen.",
    },
    CAMERA_MOVED: {
      state: "KAMERA BEWEGT",
      sentence: "Die Kamera hat sich seit der Registrierung bewegt",
      remedy: "Anhalten und neu registrieren.",
    },
    REFERENCE_MOVED: {
      state: "PATIENTENMARKER BEWEGT",
      sentence: "Der Marker am Patienten hat sich seit der Registrierung bewegt",
      remedy: "Anhalten, ihn befestigen und neu registrieren.",
    },
    REGISTRATION_OUT_OF_DATE: {
      state: "REGISTRIERUNG VERALTET",
      sentence: "Worauf die Registrierung steht, wurde geändert",
      remedy: "Anhalten und neu registrieren.",
    },
    CALIBRATION_OUT_OF_DATE: {
      state: "KALIBRIERUNG VERALTET",
      sentence: "Die Kalibrierung gilt nicht mehr",
      remedy: "Anhalten, neu kalibrieren, dann neu registrieren.",
    },
    CHECK_DUE: {
      state: "PRÜFUNG FÄLLIG",
      sentence: "Seit der letzten Prüfung an der Anatomie",
      remedy: "Die Spitze auf eine nicht benutzte Landmarke setzen und prüfen.",
    },
    NO_ARMED_SCREEN: {
      state: "KEIN TON",
      sentence: "Auf keinem Bildschirm ist der Ton bereit",
      remedy: "Die Alarmzeile des OP-Bildschirms einmal berühren.",
    },
    DISK_NEARLY_FULL: {
      state: "PLATTE FAST VOLL",
      sentence: "Platz, der für Fälle bleibt",
      remedy: "Platz auf der Platte schaffen.",
    },
    VIEWER_LOST: {
      state: "BILDSCHIRM VERLOREN",
      sentence: "Ein Bildschirm mit bereitem Ton ist weg",
      remedy: "Nachsehen, ob der OP-Bildschirm die Seite noch zeigt.",
    },
    RECORDING_STOPPED: {
      state: "NICHT AUFGEZEICHNET",
      sentence: "Was jetzt geschieht, wird nicht geschrieben",
      remedy: "Nachsehen, ob die Platte voll oder weg ist.",
    },
    HOLD_ASKED: {
      state: "BITTE ANHALTEN",
      sentence: "Ein Kollege bittet anzuhalten",
      remedy: "Vor dem Weitermachen mit ihm sprechen.",
    },
  },
};
