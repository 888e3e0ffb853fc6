// What there is to say, in every language.
import type { Cause } from "../live/assess";
import type { ImageClock, MotionDetection, Priority, UnseenReason, Wall } from "../live/messages";

import type { AuditWords } from "./audit/en";
import type { CameraWords } from "./camera/en";
import type { CaseWords } from "./case/en";
import type { CheckWords } from "./check/en";
import type { EnterWords } from "./enter/en";
import type { LatencyWords } from "./latency/en";
import type { LineWords } from "./line/en";
import type { MarksWords } from "./marks/en";
import type { NavigateWords } from "./navigate/en";
import type { OperatorWords } from "./operator/en";
import type { PeopleWords } from "./people/en";
import type { PhoneWords } from "./phone/en";
import type { PlanWords } from "./plan/en";
import type { RegistrationWords } from "./registration/en";
import type { ReportWords } from "./report/en";
import type { RestWords } from "./rest/en";
import type { RoomWords } from "./room/en";
import type { RestartWords } from "./restart/en";
import type { ShellWords } from "./shell/en";
import type { SupervisorWords } from "./supervisor/en";
import type { TheatreWords } from "./theatre/en";
import type { ToolWords } from "./tool/en";

/** A short state in big words, and a sentence that says what it means or what to do. */
export interface Saying {
  state: string;
  sentence: string;
}

export interface Words {
  language: string;
  product: string;
  notice: string;
  skip: string;
  video: { title: string; none: string; late: string; image: string; age: string; alt: string };
  numbers: {
    title: string;
    none: string;
    tracking: string;
    error: string;
    errorUnknown: string;
    steadied: string;
    whileMoving: string;
    latencyUnknown: string;
    numbersOf: string;
    pictureOf: string;
  };
  reading: Record<
    "entry" | "angle" | "depth" | "toGo" | "wall",
    { name: string; hint: string; unit: string }
  >;
  wall: Record<"outside" | "soon" | "atEnd" | "risk", string> & { side: Record<Wall, string> };
  moves: Record<MotionDetection, string>;
  depthWords: { before: string; inside: string; past: string; across: string };
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
  foundBy: Record<"search" | "track", string>;
  header: Record<
    "case" | "source" | "camera" | "server" | "searchTime" | "rate" | "noRegistration" | "registeredBy",
    string
  >;
  cameraState: Record<"opening" | "running" | "reconnecting" | "ended" | "unknown", string>;
  imageClock: Record<ImageClock, string>;
  linkState: Record<"connecting" | "open" | "lost" | "not-reached", string>;
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
  alerts: { title: string; remedy: string };
  alarms: Record<
    | "title"
    | "none"
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
  cause: Record<Cause, Saying>;
  unseen: Record<UnseenReason, string>;
  shell: ShellWords;
  line: LineWords;
  enter: EnterWords;
  rest: RestWords;
  restart: RestartWords;
  operator: OperatorWords;
  theatre: TheatreWords;
  case: CaseWords;
  camera: CameraWords;
  latency: LatencyWords;
  tool: ToolWords;
  people: PeopleWords;
  phone: PhoneWords;
  audit: AuditWords;
  plan: PlanWords;
  registration: RegistrationWords;
  check: CheckWords;
  navigate: NavigateWords;
  report: ReportWords;
  supervisor: SupervisorWords;
  marks: MarksWords;
  room: RoomWords;
}
