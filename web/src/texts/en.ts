// All texts of the page. A further language is another file of this type.
import { alarmsEn } from "./alarmsEn";
import { cameraEn } from "./camera/en";
import { caseEn } from "./case/en";
import { checkEn } from "./check/en";
import { helpEn } from "./help/en";
import { hubEn } from "./hub/en";
import { signInEn } from "./signin/en";
import { certificateEn } from "./certificate/en";
import { latencyEn } from "./latency/en";
import { connectionEn } from "./connection/en";
import { navigateEn } from "./navigate/en";
import { setupCheckEn } from "./setupCheck/en";
import { marksEn } from "./marks/en";
import { operatorEn } from "./operator/en";
import { auditEn } from "./audit/en";
import { peopleEn } from "./people/en";
import { phoneEn } from "./phone/en";
import { planEn } from "./plan/en";
import { reasonsEn } from "./reasons/en";
import { recordingEn } from "./recording/en";
import { registrationEn } from "./registration/en";
import { reportEn } from "./report/en";
import { restEn } from "./rest/en";
import { roomEn } from "./room/en";
import { restartEn } from "./restart/en";
import { shellEn } from "./shell/en";
import { supervisorEn } from "./supervisor/en";
import { theatreEn } from "./theatre/en";
import { toolEn } from "./tool/en";
import { tourEn } from "./tour/en";
import type { Texts } from "./catalogue";

export type { StateText, Texts } from "./catalogue";

export const en: Texts = {
  language: "en",
  product: "Coaxial",
  notice: "Research software, not a medical device",
  skip: "Skip to the numbers",
  video: {
    title: "Video",
    none: "NO VIDEO",
    image: "image",
    age: "age",
    alt: "Live video with the planned channel and the line of the drill",
  },
  numbers: {
    title: "Drill to channel",
    none: "NO TRACKING",
    tracking: "TRACKING",
    error: "95 % error",
    errorUnknown: "95 % error unknown",
    steadied: "smoothed, delayed by",
    whileMoving: "while moving",
    nearerTo: "Drill nearer to {channel}",
    switchUnderNavigation: "switch under Navigation",
    switchBelow: "switch below",
    latencyUnknown: {
      measure: "moving: measure the latency in the step Camera",
      simulated: "moving, latency unknown: simulated camera",
    },
    trend: "{figure} in the last 30 s, with its limit",
  },
  reading: {
    entry: { name: "Entry", hint: "off the entry point", unit: "mm" },
    angle: { name: "Angle", hint: "to the channel's axis", unit: "°" },
    depth: { name: "Depth", hint: "past the entry plane", unit: "mm" },
    toGo: { name: "To go", hint: "to the planned end", unit: "mm" },
    wall: { name: "Wall", hint: "smallest distance of the drill", unit: "mm" },
  },
  wall: {
    outside: "outside",
    soon: "in 2 mm",
    atEnd: "screw at the end",
    risk: "Risk of breach",
    side: {
      medial: "medial",
      lateral: "lateral",
      cranial: "cranial",
      caudal: "caudal",
      anterior: "anterior",
    },
  },
  moves: {
    reference: "The patient marker shows whether patient or camera moves.",
    "fixed-scene":
      "No patient marker: patient movement is not detected, camera movement only from the background.",
    "not-at-all": "No patient marker: movement of patient or camera is not detected.",
  },
  depthTexts: {
    before: "before entry",
    inside: "past the entry plane",
    past: "TOO DEEP",
    across: "drill lies across the channel",
  },
  scene: {
    title: "3-D",
    loading: "3-D LOADING",
    loadingHint: "The scene appears with its first image.",
    stale: "SCENE STALE",
    staleHint: "The scene does not follow the drill at present. It returns automatically.",
    unsupported: "NO 3-D",
    unsupportedHint: "This browser has no WebGL 2. Video and numbers work without it.",
    off: "3-D OFF",
    offHint: "This computer has no graphics card: 3-D would delay the numbers.",
    show: "Show 3-D",
    views: "View",
    view: { behind: "From behind", channel: "Along channel", camera: "From camera" },
  },
  markers: {
    title: "Markers",
    none: "No marker is loaded.",
    name: "Marker",
    state: "State",
    seen: "seen",
    unseen: "not seen",
    score: "Score",
    target: "Target score",
    unknown: "not known",
  },
  foundBy: { search: "found by search", track: "tracked", external: "by an external tracker" },
  header: {
    case: "Channel",
    source: "Source",
    camera: "Camera",
    server: "Server",
    searchTime: "Search time",
    rate: "Rate",
    noRegistration: "not registered",
    registeredBy: "registered by",
  },
  cameraState: {
    opening: "opening",
    running: "running",
    reconnecting: "reconnecting",
    ended: "ended",
    unknown: "not known",
  },
  imageClock: {
    driver: "the camera's driver",
    device: "the camera's clock",
    sender: "the sender of the stream",
    browser: "the phone's browser",
    arrival: "arrival at the server",
  },
  linkState: {
    connecting: "connecting",
    open: "connected",
    late: "no message for {age}",
    lost: "lost, reconnecting",
    "not-reached": "not reached",
  },
  details: {
    title: "Times and counts",
    stages: "Time of each stage",
    stage: "Stage",
    time: "Time",
    skipped: "Skipped images",
    restarts: "Restarts of tracking",
    images: "Images",
    size: "Image size",
    clock: "Image time from",
    mode: "Camera mode",
    version: "Version",
    plainVideo: "Plain video for other screens",
    guide: "User guide",
  },
  alerts: { remedy: "What to do:" },
  alarms: alarmsEn,
  ...reasonsEn,
  shell: shellEn,
  connection: connectionEn,
  signIn: signInEn,
  help: helpEn,
  tour: tourEn,
  rest: restEn,
  restart: restartEn,
  operator: operatorEn,
  theatre: theatreEn,
  case: caseEn,
  camera: cameraEn,
  certificate: certificateEn,
  latency: latencyEn,
  tool: toolEn,
  people: peopleEn,
  phone: phoneEn,
  audit: auditEn,
  plan: planEn,
  recording: recordingEn,
  registration: registrationEn,
  check: checkEn,
  navigate: navigateEn,
  setupCheck: setupCheckEn,
  report: reportEn,
  supervisor: supervisorEn,
  hub: hubEn,
  marks: marksEn,
  room: roomEn,
};
