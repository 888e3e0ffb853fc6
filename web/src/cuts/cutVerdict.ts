// Whether a cut may be shown, and as what. Pure: it is covered for the same reasons and at the same moment as figures.
import type { Cause, NumbersVerdict } from "../live/assess";
import type { ChannelMessage } from "../live/messages";
import { Rejection, type Problem } from "../rest/client";
import type { CutSubject } from "./cutter";

/** What this page has of the CT around the vertebra. */
export type VolumeState =
  | { state: "none" }
  | { state: "loading" }
  | { state: "scanning" }
  /** It is loaded when somebody asks for it. */
  | { state: "on_request" }
  | { state: "rejected"; problem: Problem }
  /** What came could not be read; without the message where nothing came. */
  | { state: "failed"; message: string }
  | { state: "unsupported" }
  | { state: "ready"; ctId: string };

/** Why there is no CT to cut, for now or at all. */
export type NoVolume = Exclude<VolumeState, { state: "ready" }>;

export type CutVerdict =
  | { state: "live"; ageMs: number }
  /** Drill and plan alone, which need no CT. */
  | { state: "bare"; ageMs: number; volume: NoVolume }
  /** The planned channel alone, without a drill. */
  | { state: "plan" }
  | { state: "covered"; why: "late" | "unread" | Cause };

/** What there is of a CT after loading it has failed. */
export function volumeAfter(error: unknown): VolumeState {
  if (error instanceof Rejection) {
    const { problem } = error;
    return problem.message === "" ? { state: "failed", message: "" } : { state: "rejected", problem };
  }
  return { state: "failed", message: error instanceof Error ? error.message : String(error) };
}

/** Numbers that go for a moment are no reason to show something else. */
export const PLAN_AFTER_MS = 1000;

/** Whether cuts of the plan are wanted: the newest image says itself why it has no figures, and has said so for a while. */
export function wantsPlan(numbers: NumbersVerdict, untrackedMs: number | null): boolean {
  return !numbers.live && numbers.cause === "unread" && (untrackedMs ?? Infinity) > PLAN_AFTER_MS;
}

/**
 * The verdict on a cut that is displayed (null where none is).
 *
 * `volume`, `channel` and `numbers` are those of the newest message; `limitMs` is the greatest age of a drawing that
 * follows the drill, as for the 3-D scene.
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
  // A pose of one CT in the voxels of another would be a place that nobody planned.
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
