// Deutsch.
import { alarmsDe } from "./alarmsDe";
import type { Words } from "./en";

export const de: Words = {
  language: "de",
  product: "Coaxial",
  notice: "Forschungssoftware, kein Medizinprodukt",
  skip: "Zu den Zahlen",
  video: {
    title: "Video",
    none: "KEIN VIDEO",
    late: "BILD KOMMT SPÄT",
    image: "Bild",
    age: "Alter",
    alt: "Live-Video mit geplantem Kanal und Bohrerlinie",
  },
  numbers: {
    title: "Bohrer zum Kanal",
    none: "KEIN TRACKING",
    noNumbers: "KEINE ZAHLEN",
    tracking: "TRACKING",
    tip: "Spitze ±",
    tipUnknown: "Unsicherheit der Spitze unbekannt",
    steadied: "beruhigt, verzögert um",
    numbersOf: "Zahlen sind von Bild",
    pictureOf: "Bild ist Nummer",
  },
  reading: {
    entry: { name: "Eintritt", hint: "neben dem Eintrittspunkt", unit: "mm" },
    angle: { name: "Winkel", hint: "zur Kanalachse", unit: "°" },
    depth: { name: "Tiefe", hint: "hinter der Eintrittsebene", unit: "mm" },
    toGo: { name: "Rest", hint: "bis zum geplanten Ende", unit: "mm" },
  },
  depthWords: {
    before: "vor der Eintrittsebene",
    inside: "hinter der Eintrittsebene",
    past: "GEPLANTES ENDE ÜBERSCHRITTEN",
    across: "Bohrer liegt quer zum Kanal",
  },
  scene: {
    title: "3-D",
    loading: "3-D LÄDT",
    loadingHint: "Die Szene erscheint mit ihrem ersten Bild.",
    stale: "SZENE VERALTET",
    staleHint: "Die Szene folgt dem Bohrer nicht. Sie kommt von selbst wieder.",
  },
  markers: {
    title: "Marker",
    none: "Kein Marker geladen.",
    name: "Marker",
    state: "Zustand",
    seen: "gesehen",
    unseen: "nicht gesehen",
    score: "Score",
    target: "Target-Score",
    unknown: "unbekannt",
  },
  foundBy: { search: "durch Suche gefunden", track: "verfolgt" },
  header: {
    case: "Kanal",
    source: "Quelle",
    camera: "Kamera",
    server: "Server",
    searchTime: "Suchzeit",
    rate: "Rate",
    noRegistration: "nicht registriert",
    registeredBy: "registriert durch",
  },
  cameraState: {
    opening: "wird geöffnet",
    running: "läuft",
    reconnecting: "verbindet neu",
    ended: "am Ende",
    unknown: "unbekannt",
  },
  linkState: { connecting: "verbindet", open: "verbunden", lost: "weg, verbindet neu" },
  details: {
    title: "Zeiten und Zähler",
    stages: "Zeit je Stufe",
    stage: "Stufe",
    time: "Zeit",
    skipped: "Übersprungene Bilder",
    restarts: "Neustarts der Verfolgung",
    images: "Bilder",
    size: "Bildgröße",
    version: "Version",
    plainVideo: "Einfaches Video für andere Bildschirme",
  },
  alerts: { title: "Meldungen", remedy: "Was zu tun ist:" },
  alarms: alarmsDe,
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
  },
  unseen: {
    NO_CANDIDATE: "nichts im Bild sieht ihm ähnlich",
    SCORE_TOO_LOW: "zu wenige seiner Kanten sind da",
    TARGET_SCORE_TOO_LOW: "Kanten, die er nicht hat",
    SHAPE_DIFFERS: "innen eine andere Form: ein Doppelgänger",
  },
};
