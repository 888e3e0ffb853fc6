// Type of the text catalogue; every language implements it.
import type { Cause } from "../live/assess";
import type { ImageClock, MotionDetection, Priority, UnseenReason, Wall } from "../live/messages";

import type { AuditTexts } from "./audit/en";
import type { CameraTexts } from "./camera/en";
import type { CaseTexts } from "./case/en";
import type { CheckTexts } from "./check/en";
import type { HelpTexts } from "./help/en";
import type { HubTexts } from "./hub/en";
import type { SignInTexts } from "./signin/en";
import type { CertificateTexts } from "./certificate/en";
import type { LatencyTexts } from "./latency/en";
import type { ConnectionTexts } from "./connection/en";
import type { MarksTexts } from "./marks/en";
import type { NavigateTexts } from "./navigate/en";
import type { SetupCheckTexts } from "./setupCheck/en";
import type { OperatorTexts } from "./operator/en";
import type { PeopleTexts } from "./people/en";
import type { PhoneTexts } from "./phone/en";
import type { PlanTexts } from "./plan/en";
import type { RecordingTexts } from "./recording/en";
import type { RegistrationTexts } from "./registration/en";
import type { ReportTexts } from "./report/en";
import type { RestTexts } from "./rest/en";
import type { RoomTexts } from "./room/en";
import type { RestartTexts } from "./restart/en";
import type { ShellTexts } from "./shell/en";
import type { SupervisorTexts } from "./supervisor/en";
import type { TheatreTexts } from "./theatre/en";
import type { ToolTexts } from "./tool/en";
import type { TourTexts } from "./tour/en";

/** A short state in capitals, and a sentence with its meaning or remedy. */
export interface StateText {
  state: string;
  sentence: string;
}

export interface Texts {
  language: string;
  product: string;
  notice: string;
  skip: string;
  video: { title: string; none: string; image: string; age: string; alt: string };
  numbers: {
    title: string;
    none: string;
    tracking: string;
    error: string;
    errorUnknown: string;
    steadied: string;
    whileMoving: string;
    nearerTo: string;
    switchUnderNavigation: string;
    switchBelow: string;
    latencyUnknown: Record<"measure" | "simulated", string>;
    trend: string;
  };
  reading: Record<
    "entry" | "angle" | "depth" | "toGo" | "wall",
    { name: string; hint: string; unit: string }
  >;
  wall: Record<"outside" | "soon" | "atEnd" | "risk", string> & { side: Record<Wall, string> };
  moves: Record<MotionDetection, string>;
  depthTexts: { before: string; inside: string; past: string; across: string };
  scene: {
    title: string;
    loading: string;
    loadingHint: string;
    stale: string;
    staleHint: string;
    unsupported: string;
    unsupportedHint: string;
    off: string;
    offHint: string;
    show: string;
    views: string;
    view: Record<"behind" | "channel" | "camera", string>;
  };
  markers: Record<
    "title" | "none" | "name" | "state" | "seen" | "unseen" | "score" | "target" | "unknown",
    string
  >;
  foundBy: Record<"search" | "track" | "external", string>;
  header: Record<
    "case" | "source" | "camera" | "server" | "searchTime" | "rate" | "noRegistration" | "registeredBy",
    string
  >;
  cameraState: Record<"opening" | "running" | "reconnecting" | "ended" | "unknown", string>;
  imageClock: Record<ImageClock, string>;
  linkState: Record<"connecting" | "open" | "late" | "lost" | "not-reached", string>;
  details: Record<
    | "title"
    | "stages"
    | "stage"
    | "time"
    | "skipped"
    | "restarts"
    | "images"
    | "size"
    | "clock"
    | "mode"
    | "version"
    | "plainVideo"
    | "guide",
    string
  >;
  alerts: { remedy: string };
  alarms: Record<
    | "title"
    | "none"
    | "all"
    | "details"
    | "unknown"
    | "acknowledge"
    | "pause"
    | "paused"
    | "resume"
    | "failed"
    | "arm"
    | "armFailed"
    | "armed"
    | "over",
    string
  > & { priority: Record<Priority, string> };
  cause: Record<Cause, StateText>;
  unseen: Record<UnseenReason, string>;
  shell: ShellTexts;
  connection: ConnectionTexts;
  signIn: SignInTexts;
  help: HelpTexts;
  tour: TourTexts;
  rest: RestTexts;
  restart: RestartTexts;
  operator: OperatorTexts;
  theatre: TheatreTexts;
  case: CaseTexts;
  camera: CameraTexts;
  certificate: CertificateTexts;
  latency: LatencyTexts;
  tool: ToolTexts;
  people: PeopleTexts;
  phone: PhoneTexts;
  audit: AuditTexts;
  plan: PlanTexts;
  recording: RecordingTexts;
  registration: RegistrationTexts;
  check: CheckTexts;
  navigate: NavigateTexts;
  setupCheck: SetupCheckTexts;
  report: ReportTexts;
  supervisor: SupervisorTexts;
  hub: HubTexts;
  marks: MarksTexts;
  room: RoomTexts;
}
