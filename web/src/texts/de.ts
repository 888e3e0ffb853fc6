// Deutsch.
import { alarmsDe } from "./alarmsDe";
import { cameraDe } from "./camera/de";
import { caseDe } from "./case/de";
import { checkDe } from "./check/de";
import { helpDe } from "./help/de";
import { hubDe } from "./hub/de";
import { signInDe } from "./signin/de";
import { certificateDe } from "./certificate/de";
import { latencyDe } from "./latency/de";
import { connectionDe } from "./connection/de";
import { navigateDe } from "./navigate/de";
import { setupCheckDe } from "./setupCheck/de";
import { marksDe } from "./marks/de";
import { operatorDe } from "./operator/de";
import { auditDe } from "./audit/de";
import { peopleDe } from "./people/de";
import { phoneDe } from "./phone/de";
import { planDe } from "./plan/de";
import { reasonsDe } from "./reasons/de";
import { recordingDe } from "./recording/de";
import { registrationDe } from "./registration/de";
import { reportDe } from "./report/de";
import { restDe } from "./rest/de";
import { roomDe } from "./room/de";
import { restartDe } from "./restart/de";
import { shellDe } from "./shell/de";
import { supervisorDe } from "./supervisor/de";
import { theatreDe } from "./theatre/de";
import { toolDe } from "./tool/de";
import { tourDe } from "./tour/de";
import type { Texts } from "./en";

export const de: Texts = {
  language: "de",
  product: "Coaxial",
  notice: "Forschungssoftware, kein Medizinprodukt",
  skip: "Zu den Werten",
  video: {
    title: "Video",
    none: "KEIN VIDEO",
    image: "Bild",
    age: "Alter",
    alt: "Live-Video mit geplantem Kanal und Linie des Bohrers",
  },
  numbers: {
    title: "Bohrer zum Kanal",
    none: "KEIN TRACKING",
    tracking: "TRACKING",
    error: "95-%-Fehler",
    errorUnknown: "95-%-Fehler unbekannt",
    steadied: "geglättet, verzögert um",
    whileMoving: "in Bewegung",
    nearerTo: "Bohrer näher an {channel}",
    switchUnderNavigation: "Wechsel unter Navigation",
    switchBelow: "Wechsel weiter unten",
    latencyUnknown: {
      measure: "in Bewegung: Latenz im Schritt Kamera messen",
      simulated: "in Bewegung, Latenz unbekannt: simulierte Kamera",
    },
    trend: "{figure} der letzten 30 s, mit Grenze",
  },
  reading: {
    entry: { name: "Eintritt", hint: "Abstand vom Eintrittspunkt", unit: "mm" },
    angle: { name: "Winkel", hint: "zur Kanalachse", unit: "°" },
    depth: { name: "Tiefe", hint: "hinter der Eintrittsebene", unit: "mm" },
    toGo: { name: "Rest", hint: "bis zum geplanten Ende", unit: "mm" },
    wall: { name: "Wand", hint: "kleinster Abstand des Bohrers", unit: "mm" },
  },
  wall: {
    outside: "außerhalb",
    soon: "in 2 mm",
    atEnd: "Schraube am Ende",
    risk: "Durchbruchrisiko",
    side: {
      medial: "medial",
      lateral: "lateral",
      cranial: "kranial",
      caudal: "kaudal",
      anterior: "vorn",
    },
  },
  moves: {
    reference: "Der Patientenmarker zeigt, ob sich Patient oder Kamera bewegen.",
    "fixed-scene":
      "Kein Patientenmarker: Bewegungen des Patienten werden nicht erkannt, Bewegungen der Kamera nur am Hintergrund.",
    "not-at-all": "Kein Patientenmarker: Bewegungen von Patient oder Kamera werden nicht erkannt.",
  },
  depthTexts: {
    before: "vor Eintritt",
    inside: "hinter der Eintrittsebene",
    past: "ZU TIEF",
    across: "Bohrer quer zum Kanal",
  },
  scene: {
    title: "3-D",
    loading: "3-D LÄDT",
    loadingHint: "Die Szene erscheint mit ihrem ersten Bild.",
    stale: "SZENE VERALTET",
    staleHint: "Die Szene folgt dem Bohrer derzeit nicht. Sie erscheint automatisch wieder.",
    unsupported: "KEIN 3-D",
    unsupportedHint: "Dieser Browser hat kein WebGL 2. Video und Werte funktionieren auch ohne.",
    off: "3-D AUS",
    offHint: "Dieser Rechner hat keine Grafikkarte: 3-D würde die Werte verzögern.",
    show: "3-D anzeigen",
    views: "Ansicht",
    view: { behind: "Von hinten", channel: "Entlang des Kanals", camera: "Von der Kamera" },
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
  foundBy: { search: "durch Suche gefunden", track: "verfolgt", external: "vom externen Trackingsystem" },
  header: {
    case: "Kanal",
    source: "Quelle",
    camera: "Kamera",
    server: "Server",
    searchTime: "Suchzeit",
    rate: "Rate",
    noRegistration: "nicht registriert",
    registeredBy: "registriert von",
  },
  cameraState: {
    opening: "wird geöffnet",
    running: "läuft",
    reconnecting: "verbindet neu",
    ended: "beendet",
    unknown: "unbekannt",
  },
  imageClock: {
    driver: "dem Kameratreiber",
    device: "der Uhr der Kamera",
    sender: "dem Sender des Videos",
    browser: "dem Browser des Telefons",
    arrival: "dem Eingang beim Server",
  },
  linkState: {
    connecting: "verbindet",
    open: "verbunden",
    late: "seit {age} keine Nachricht",
    lost: "getrennt, verbindet neu",
    "not-reached": "nicht erreicht",
  },
  details: {
    title: "Zeiten und Zähler",
    stages: "Zeit je Schritt",
    stage: "Schritt",
    time: "Zeit",
    skipped: "Übersprungene Bilder",
    restarts: "Neustarts des Trackings",
    images: "Bilder",
    size: "Bildgröße",
    clock: "Bildzeit nach",
    mode: "Kameramodus",
    version: "Version",
    plainVideo: "Einfaches Video für andere Bildschirme",
    guide: "Anleitung (englisch)",
  },
  alerts: { remedy: "Was zu tun ist:" },
  alarms: alarmsDe,
  ...reasonsDe,
  shell: shellDe,
  connection: connectionDe,
  signIn: signInDe,
  help: helpDe,
  tour: tourDe,
  rest: restDe,
  restart: restartDe,
  operator: operatorDe,
  theatre: theatreDe,
  case: caseDe,
  camera: cameraDe,
  certificate: certificateDe,
  latency: latencyDe,
  tool: toolDe,
  people: peopleDe,
  phone: phoneDe,
  audit: auditDe,
  plan: planDe,
  recording: recordingDe,
  registration: registrationDe,
  check: checkDe,
  navigate: navigateDe,
  setupCheck: setupCheckDe,
  report: reportDe,
  supervisor: supervisorDe,
  hub: hubDe,
  marks: marksDe,
  room: roomDe,
};
