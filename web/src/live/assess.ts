// What may be shown now. Pure: takes a situation and a time, returns a verdict per pane.
import { firstMessageAt, type FirstMessageWait } from "./firstMessage";
import type { Reading } from "./reading";
import { readingOf, type Unread } from "./reading";
import type { HeadlineMessage, LiveMessage, SnapshotMessage } from "./messages";
import type { LinkState } from "./viewConnection";

export interface Limits {
  pose_stale_after_ms: number;
  video_stale_after_ms: number;
  scene_stale_after_ms: number;
}

/** A message with its capture time on the page's clock. */
export interface ReceivedImage {
  snapshot: SnapshotMessage;
  headline: HeadlineMessage;
  capturedAtMs: number;
  receivedAtMs: number;
}

export interface Situation extends FirstMessageWait {
  link: LinkState;
  hidden: boolean;
  lastReceivedAtMs: number | null;
  newest: LiveMessage | null;
  /** Image whose numbers are displayed. */
  numbers: ReceivedImage | null;
  /** Image whose picture is displayed. */
  picture: ReceivedImage | null;
  /** Capture time of the last displayed picture, even if removed; null before the first of this connection. */
  lastPictureAtMs: number | null;
  /** Since when there is a canvas without a picture; null without one. */
  canvasSinceMs: number | null;
  limits: Limits;
}

/** Defaults until the server has sent its limits. */
const DEFAULT_LIMITS: Limits = {
  pose_stale_after_ms: 150,
  video_stale_after_ms: 500,
  scene_stale_after_ms: 500,
};

/** State of a page that has just loaded. */
export function situationAtLoad(nowMs: number): Situation {
  return {
    link: "connecting",
    hidden: false,
    everReceived: false,
    waitingSinceMs: nowMs,
    lastReceivedAtMs: null,
    newest: null,
    numbers: null,
    picture: null,
    lastPictureAtMs: null,
    canvasSinceMs: null,
    limits: DEFAULT_LIMITS,
  };
}

/** Reasons why a pane is empty, ordered from the server to the image. */
export type Cause =
  | "hidden"
  | "connecting"
  | "not-reached"
  | "server-gone"
  | "process-starting"
  | "process-restarting"
  | "process-given_up"
  | "source-opening"
  | "source-reconnecting"
  | "source-ended"
  | "no-image"
  | "no-picture"
  | "old";

export type VideoVerdict =
  | { live: true; imageNumber: number; ageMs: number; snapshot: SnapshotMessage }
  | { live: false; cause: Cause; ageMs: number | null };

export type NumbersVerdict =
  | { live: true; reading: Reading; imageNumber: number; ageMs: number; snapshot: SnapshotMessage }
  | { live: false; cause: Cause | "unread"; unread: Unread | null; ageMs: number | null };

/** An open connection silent for this long means that the server is lost. */
export const SILENT_AFTER_MS = 800;

/** Whether the server is heard now. Header and alarms state the same: one that is not heard knows no alarms. */
export function isServerHeard({
  link,
  silentMs,
  newest,
}: {
  link: LinkState;
  silentMs: number;
  newest: LiveMessage | null;
}): boolean {
  return link === "open" && newest !== null && silentMs <= SILENT_AFTER_MS;
}

/** On a loaded machine a new canvas, as after a change of step, has its first picture within this time. */
export const FIRST_PICTURE_WITHIN_MS = 2000;

export function videoVerdict(situation: Situation, nowMs: number): VideoVerdict {
  const { picture, lastPictureAtMs, canvasSinceMs, limits } = situation;
  const capturedAtMs = picture?.capturedAtMs ?? lastPictureAtMs;
  const ageMs = capturedAtMs === null ? null : nowMs - capturedAtMs;
  const cause = commonCause(situation, nowMs);
  if (cause !== null) return { live: false, cause, ageMs };
  const isNewCanvas = canvasSinceMs !== null && nowMs - canvasSinceMs <= FIRST_PICTURE_WITHIN_MS;
  if (ageMs === null || (picture === null && isNewCanvas)) {
    return { live: false, cause: isNewCanvas ? "connecting" : "no-picture", ageMs: null };
  }
  // A picture removed for its age stays "too old" until a new one is displayed.
  if (picture === null || !(ageMs <= limits.video_stale_after_ms))
    return { live: false, cause: "old", ageMs };
  const { snapshot } = picture;
  return { live: true, imageNumber: snapshot.image_number, ageMs, snapshot };
}

export function numbersVerdict(situation: Situation, nowMs: number): NumbersVerdict {
  const { numbers, limits } = situation;
  const ageMs = numbers === null ? null : nowMs - numbers.capturedAtMs;
  const cause = commonCause(situation, nowMs);
  if (cause !== null) return { live: false, cause, unread: null, ageMs };
  if (numbers === null || ageMs === null) {
    return { live: false, cause: "no-picture", unread: null, ageMs: null };
  }
  const reading = readingOf(numbers.snapshot, numbers.headline);
  // The reason for missing figures may be shown as long as the picture of its image. Searching for a marker makes images
  // late, and "too old" would hide that the marker is not seen.
  const limitMs = reading.known ? limits.pose_stale_after_ms : limits.video_stale_after_ms;
  if (!(ageMs <= limitMs)) return { live: false, cause: "old", unread: null, ageMs };
  if (!reading.known) return { live: false, cause: "unread", unread: reading, ageMs };
  const { snapshot } = numbers;
  return { live: true, reading, imageNumber: snapshot.image_number, ageMs, snapshot };
}

/** Whether the newest image is young enough: it has figures, or a reason for having none. */
export function isOfNow(numbers: NumbersVerdict): boolean {
  return numbers.live || numbers.cause === "unread";
}

/** The reason to remove everything at once, or null. */
function commonCause(situation: Situation, nowMs: number): Cause | null {
  const { link, hidden, lastReceivedAtMs, newest } = situation;
  if (hidden) return "hidden";
  const first = firstMessageAt(situation, nowMs);
  if (first !== "received") return first === "overdue" ? "not-reached" : "connecting";
  if (link !== "open") return "server-gone";
  if (lastReceivedAtMs !== null && nowMs - lastReceivedAtMs > SILENT_AFTER_MS) return "server-gone";
  if (newest === null) return "connecting";
  if (newest.process.state !== "running") return `process-${newest.process.state}`;
  if (newest.source.state !== "running") return `source-${newest.source.state}`;
  return newest.snapshot === null ? "no-image" : null;
}
