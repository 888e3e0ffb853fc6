import { expect, test } from "vitest";
import { numbersVerdict, type NumbersVerdict } from "../live/assess";
import { channel, situation } from "../live/builders";
import { headline } from "../live/figureBuilders";
import type { CutSubject } from "./cutter";
import { Rejection } from "../rest/client";
import { cutVerdict, volumeAfter, type CutVerdict } from "./cutVerdict";

const PROBLEM = {
  code: "PLAN_MISSING",
  message: "no plan",
  remedy: "Plan.",
  context: {},
  language: "en",
} as const;

const LIVE = numbersVerdict(situation(), 1000);
const UNREAD: NumbersVerdict = {
  live: false,
  cause: "unread",
  unread: { known: false, headline: headline() },
  ageMs: 40,
};
const OF_DRILL: CutSubject = {
  kind: "live",
  imageNumber: 5,
  capturedAtMs: 900,
  pose: { tip: [0, 0, 0], axis: [0, -1, 0] },
  channel: channel(),
};
const OF_PLAN: CutSubject = { ...OF_DRILL, kind: "plan" };

function verdict(
  shown: CutSubject | null,
  changes: Partial<Parameters<typeof cutVerdict>[1]> = {},
): CutVerdict {
  return cutVerdict(shown, {
    volume: { state: "ready", ctId: "ct-1" },
    channel: channel(),
    numbers: LIVE,
    untrackedMs: null,
    nowMs: 1000,
    limitMs: 500,
    ...changes,
  });
}

test("a recent cut beside live figures is live, with the age of its own image", () => {
  expect(LIVE.live).toBe(true);
  expect(verdict(OF_DRILL)).toEqual({ state: "live", ageMs: 100 });
});

test("a stale cut is covered while figures continue", () => {
  expect(verdict(OF_DRILL, { nowMs: 1400 }).state).toBe("live");
  expect(verdict(OF_DRILL, { nowMs: 1401 })).toEqual({ state: "covered", why: "late" });
  expect(verdict(null)).toEqual({ state: "covered", why: "late" });
});

test("without live figures no cut of a drill is shown, however young", () => {
  const old: NumbersVerdict = { live: false, cause: "old", unread: null, ageMs: 200 };
  expect(verdict(OF_DRILL, { numbers: old })).toEqual({ state: "covered", why: "old" });
  expect(verdict(OF_PLAN, { numbers: old })).toEqual({ state: "covered", why: "old" });
  expect(verdict(OF_DRILL, { numbers: UNREAD, untrackedMs: 5000 })).toEqual({
    state: "covered",
    why: "unread",
  });
});

test("while the marker is not seen the plan is shown, after a second, and never beside live figures", () => {
  expect(verdict(OF_PLAN, { numbers: UNREAD, untrackedMs: 900 })).toEqual({
    state: "covered",
    why: "unread",
  });
  expect(verdict(OF_PLAN, { numbers: UNREAD, untrackedMs: 1100 })).toEqual({ state: "plan" });
  expect(verdict(OF_PLAN)).toEqual({ state: "covered", why: "late" });
});

test("a cut of another channel or another CT is not shown", () => {
  const moved = channel({ target_in_vertebra_mm: [13, -28, 0] });
  expect(verdict(OF_DRILL, { channel: moved })).toEqual({ state: "covered", why: "late" });
  const other = channel({ ct_id: "ct-2" });
  expect(verdict(OF_DRILL, { channel: other })).toEqual({
    state: "bare",
    ageMs: 40,
    volume: { state: "loading" },
  });
});

test("without a CT, drill and plan are shown alone, with the reason", () => {
  const volume = { state: "none" } as const;
  expect(verdict(null, { volume })).toEqual({ state: "bare", ageMs: 40, volume });
  expect(verdict(null, { volume, numbers: UNREAD })).toEqual({ state: "covered", why: "unread" });
});

test.each([
  ["a refusal of the server", new Rejection(PROBLEM), { state: "rejected", problem: PROBLEM }],
  ["no answer", new Rejection({ ...PROBLEM, message: "" }), { state: "failed", message: "" }],
  ["an answer that is no volume", new Error("8 voxels"), { state: "failed", message: "8 voxels" }],
])("loading that ends with %s is reported and has ended", (_, error, state) => {
  expect(volumeAfter(error)).toEqual(state);
});
