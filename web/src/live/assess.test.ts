import { describe, expect, test } from "vitest";
import { numbersVerdict, videoVerdict, type Cause, type Situation } from "./assess";
import { REACHED_WITHIN_MS } from "./firstMessage";
import { message, situation, snapshot, receivedImage } from "./builders";
import { headline } from "./figureBuilders";

const NOW = 1000;
const source = message().source;
const process = message().process;

const LOADING = {
  everReceived: false,
  newest: null,
  numbers: null,
  picture: null,
  waitingSinceMs: NOW - 5000,
};

const GONE: [string, Partial<Situation>, Cause][] = [
  ["page hidden", { hidden: true }, "hidden"],
  ["first start", { ...LOADING, link: "connecting", lastReceivedAtMs: null }, "connecting"],
  ["still loading: line open, first message not come", LOADING, "connecting"],
  [
    "still loading: open and silent for longer than a server may be",
    { ...LOADING, lastReceivedAtMs: NOW - 5000 },
    "connecting",
  ],
  ["still loading: line lost and tried again", { ...LOADING, link: "lost" }, "connecting"],
  ["still loading, in the background", { ...LOADING, hidden: true }, "hidden"],
  [
    "still loading after the whole grace time",
    { ...LOADING, waitingSinceMs: NOW - REACHED_WITHIN_MS },
    "connecting",
  ],
  [
    "no sign of the server for longer",
    { ...LOADING, waitingSinceMs: NOW - REACHED_WITHIN_MS - 1 },
    "not-reached",
  ],
  [
    "heard once, then the line lost, however short ago",
    { link: "lost", newest: null, waitingSinceMs: NOW },
    "server-gone",
  ],
  ["line open, nothing said yet", { newest: null }, "connecting"],
  ["line lost", { link: "lost" }, "server-gone"],
  ["line said to stand, but silent", { lastReceivedAtMs: NOW - 801 }, "server-gone"],
  [
    "tracking starts",
    { newest: message({ process: { ...process, state: "starting" } }) },
    "process-starting",
  ],
  [
    "tracking restarts",
    { newest: message({ process: { ...process, state: "restarting" } }) },
    "process-restarting",
  ],
  [
    "tracking given up",
    { newest: message({ process: { ...process, state: "given_up" } }) },
    "process-given_up",
  ],
  ["camera opens", { newest: message({ source: { ...source, state: "opening" } }) }, "source-opening"],
  [
    "camera lost",
    { newest: message({ source: { ...source, state: "reconnecting" } }) },
    "source-reconnecting",
  ],
  ["file at its end", { newest: message({ source: { ...source, state: "ended" } }) }, "source-ended"],
  ["no snapshot", { newest: message({ snapshot: null }) }, "no-image"],
];

describe("what takes picture and numbers away, however young they are", () => {
  test.each(GONE)("%s", (_, changes, cause) => {
    expect(videoVerdict(situation(changes), NOW)).toMatchObject({ live: false, cause });
    expect(numbersVerdict(situation(changes), NOW)).toMatchObject({ live: false, cause });
  });
});

describe("age", () => {
  test.each([
    [150, true],
    [150.1, false],
  ])("numbers %d ms old: live %s", (ageMs, live) => {
    expect(numbersVerdict(situation({ numbers: receivedImage(NOW - ageMs) }), NOW).live).toBe(live);
  });

  test.each([
    [500, true],
    [500.1, false],
  ])("picture %d ms old: live %s", (ageMs, live) => {
    expect(videoVerdict(situation({ picture: receivedImage(NOW - ageMs) }), NOW).live).toBe(live);
  });

  test.each([
    [500, "unread"],
    [500.1, "old"],
  ])("why there are no figures, %d ms old, is said as long as its picture may stand: %s", (ageMs, cause) => {
    const numbers = receivedImage(NOW - ageMs, { displayed_tool: null });
    expect(numbersVerdict(situation({ numbers }), NOW)).toMatchObject({ live: false, cause });
  });

  test("an age that is not a number is never live", () => {
    expect(numbersVerdict(situation({ numbers: receivedImage(NaN) }), NOW).live).toBe(false);
    expect(videoVerdict(situation({ picture: receivedImage(NaN) }), NOW).live).toBe(false);
  });

  test("numbers without a picture are live, the picture is not", () => {
    expect(numbersVerdict(situation({ picture: null }), NOW).live).toBe(true);
    const none = situation({ picture: null, lastPictureAtMs: null });
    expect(videoVerdict(none, NOW)).toMatchObject({ live: false, cause: "no-picture" });
  });
});

test("a picture that was taken away for its age is too old, and does not count as one that never came", () => {
  const away = situation({ picture: null, lastPictureAtMs: NOW - 700 });
  expect(videoVerdict(away, NOW)).toEqual({ live: false, cause: "old", ageMs: 700 });
});

describe("content of the image", () => {
  test("the tool chosen by the server is used, whatever its position in the list", () => {
    const known = snapshot().tools[0];
    if (!known) throw new Error("the builder has a tool");
    const numbers = receivedImage(960, { tools: [{ ...known, name: "awl" }, known] });
    expect(numbersVerdict(situation({ numbers }), NOW)).toMatchObject({
      live: true,
      reading: { tool: "drill" },
    });
  });

  test.each([
    ["none is shown", { displayed_tool: null }],
    ["the one that is shown is missing", { displayed_tool: "awl" }],
    [
      "the one that is shown has no figures",
      {
        tools: snapshot().tools.map((tool) => ({
          ...tool,
          assessment: { kind: "absent", reason: "MARKER_UNSEEN" } as const,
        })),
      },
    ],
  ])("without figures the image's headline says why: %s", (_, changes) => {
    expect(numbersVerdict(situation({ numbers: receivedImage(960, changes) }), NOW)).toMatchObject({
      live: false,
      cause: "unread",
      unread: { known: false, headline: headline() },
    });
  });
});
