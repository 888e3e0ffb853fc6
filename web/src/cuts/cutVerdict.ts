// Whether a cut may be shown, and of what. Pure. It is covered for the same reasons and at the same time as figures.
import type { Cause, NumbersVerdict } from "../live/assess";
import type { ChannelMessage } from "../live/messages";
import { Rejection, type Problem } from "../rest/client";
import type { CutSubject } from "./cutter";

/** State of the CT around the vertebra on this page. */
export type VolumeState =
  | { state: "none" }
  | { state: "loading" }
  | { state: "scanning" }
  /** Loaded on request. */
  | { state: "on_request" }
  | { state: "rejected"; problem: Problem }
  /** The answer was unreadable; the message is empty if there was no answer. */
  | { state: "failed"; message: string }
  | { state: "unsupported" }
  | { state: "ready"; ctId: string };

/** Why there is no CT. */
export type NoVolume = Exclude<VolumeState, { state: "ready" }>;

export type CutVerdict =
  | { state: "live"; ageMs: number }
  /** Drill and plan without a CT. */
  | { state: "bare"; ageMs: number; volume: NoVolume }
  /** The planned channel without a drill. */
  | { state: "plan" }
  | { state: "covered"; why: "late" | "unread" | Cause };

/** State after loading has failed. */
export function volumeAfter(error: unknown): VolumeState {
  if (error instanceof Rejection) {
    const { problem } = error;
    return problem.message === "" ? { state: "failed", message: "" } : { state: "rejected", problem };
  }
  return { state: "failed", message: error instanceof Error ? error.message : String(error) };
}

/** Numbers that disappear briefly do not switch the cut to the plan. */
const PLAN_AFTER_MS = 1000;

/** Whether to cut along the plan: the newest image has had a reason for missing figures for a while. */
export function wantsPlan(numbers: NumbersVerdict, untrackedMs: number | null): boolean {
  return !numbers.live && numbers.cause === "unread" && (untrackedMs ?? Infinity) > PLAN_AFTER_MS;
}

/**
 * Returns the verdict on the displayed cut (null if none is displayed).
 *
 * `volume`, `channel` and `numbers` belong to the newest message; `limitMs` is the maximum age of a drawing that follows
 * the drill, as for the 3-D scene.
 */
export function cutVerdict(
  shown: CutSubject | null,
  {
    volume,
    channel,
    numbers,
    untrackedMs,
    nowMs,
    limitMs,
  }: {
    volume: VolumeState;
    channel: ChannelMessage | null;
    numbers: NumbersVerdict;
    untrackedMs: number | null;
    nowMs: number;
    limitMs: number;
  },
): CutVerdict {
  if (!numbers.live && numbers.cause !== "unread") return { state: "covered", why: numbers.cause };
  // A pose in another CT's voxels would be a place that nobody planned.
  const isOfCt = volume.state === "ready" && channel !== null && channel.ct_id === volume.ctId;
  if (!isOfCt) {
    const missing = volume.state === "ready" ? ({ state: "loading" } as const) : volume;
    return numbers.live
      ? { state: "bare", ageMs: numbers.ageMs, volume: missing }
      : { state: "covered", why: "unread" };
  }
  const isOfPlan = shown !== null && isSamePlan(shown.channel, channel);
  if (!numbers.live) {
    const isPlan = isOfPlan && shown.kind === "plan" && wantsPlan(numbers, untrackedMs);
    return isPlan ? { state: "plan" } : { state: "covered", why: "unread" };
  }
  if (!isOfPlan || shown.kind !== "live") return { state: "covered", why: "late" };
  const ageMs = nowMs - shown.capturedAtMs;
  return ageMs <= limitMs ? { state: "live", ageMs } : { state: "covered", why: "late" };
}

export function isSamePlan(one: ChannelMessage, other: ChannelMessage): boolean {
  return one === other || JSON.stringify(one) === JSON.stringify(other);
}
