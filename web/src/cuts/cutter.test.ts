import { expect, test } from "vitest";
import { channel } from "../live/builders";
import { Cutter, type Cut, type CutSubject, type ToCutWorker } from "./cutter";
import { cutGrid } from "./planes";

const VOLUME = {
  ctId: "ct-1",
  voxels: { hu: new Int16Array(8), size: [2, 2, 2] as const, indexFromLps: [] },
};
const GREY = { window_hu: 1800, level_hu: 400 };

function subject(imageNumber: number, kind: CutSubject["kind"] = "live"): CutSubject {
  return {
    kind,
    imageNumber,
    capturedAtMs: 0,
    pose: { tip: [0, 0, 0], axis: [0, -1, 0] },
    channel: channel(),
  };
}

function started(): {
  cutter: Cutter;
  posted: ToCutWorker[];
  shown: number[];
  reply: (tookMs: number) => void;
} {
  const posted: ToCutWorker[] = [];
  const shown: number[] = [];
  const cutter = new Cutter();
  cutter.connect((message) => {
    if (message.kind === "cut") posted.push(message);
  });
  cutter.setVolume(VOLUME);
  cutter.add({
    name: "axial",
    gridFor: (pose) => ({ grid: cutGrid("axial", pose, { widthMm: 2, heightMm: 2 }, 0), aheadMm: 0 }),
    show: (cut: Cut) => shown.push(cut.subject.imageNumber),
  });
  const reply = (tookMs: number): void => {
    const last = posted.at(-1);
    if (last?.kind !== "cut") throw new Error("nothing was ordered");
    cutter.receive({ job: last.job, tookMs, cuts: [{ name: "axial", buffer: new ArrayBuffer(256) }] });
  };
  return { cutter, posted, shown, reply };
}

test("one cut at a time, of the newest pose, at most ten times a second", () => {
  const { cutter, posted, shown, reply } = started();
  cutter.update(0, subject(1), GREY, 100);
  cutter.update(30, subject(2), GREY, 100);
  reply(4);
  cutter.update(60, subject(3), GREY, 100);
  expect(posted).toHaveLength(1);
  cutter.update(100, subject(4), GREY, 100);
  reply(4);
  expect(shown).toEqual([1, 4]);
});

test("cuts follow the interval of the page's budget", () => {
  const { cutter, posted, reply } = started();
  cutter.update(0, subject(1), GREY, 200);
  reply(4);
  cutter.update(199, subject(2), GREY, 200);
  expect(posted).toHaveLength(1);
  cutter.update(200, subject(3), GREY, 200);
  expect(posted).toHaveLength(2);
});

test("cuts that take long are made less often: 15 % of the worker's time", () => {
  const { cutter, posted, reply } = started();
  cutter.update(0, subject(1), GREY, 100);
  reply(60);
  cutter.update(390, subject(2), GREY, 100);
  expect(posted).toHaveLength(1);
  cutter.update(400, subject(3), GREY, 100);
  expect(posted).toHaveLength(2);
});

test("a buffer that was shown is given back, and nothing is cut without a subject", () => {
  const { cutter, posted, reply } = started();
  cutter.update(0, subject(1), GREY, 100);
  reply(1);
  cutter.update(150, null, GREY, 100);
  expect(posted).toHaveLength(1);
  cutter.update(200, subject(2), GREY, 100);
  const last = posted.at(-1);
  expect(last?.kind === "cut" ? last.spare.map((one) => one.byteLength) : null).toEqual([256]);
});

test("a cut of the volume before is never shown", () => {
  const { cutter, shown, posted } = started();
  cutter.update(0, subject(1), GREY, 100);
  const first = posted.at(-1);
  cutter.setVolume(VOLUME);
  if (first?.kind !== "cut") throw new Error("nothing was ordered");
  cutter.receive({ job: first.job, tookMs: 1, cuts: [{ name: "axial", buffer: new ArrayBuffer(256) }] });
  expect(shown).toEqual([]);
});

test("a pose in one CT is never cut from the voxels of another", () => {
  const { cutter, posted } = started();
  cutter.update(0, { ...subject(1), channel: channel({ ct_id: "ct-2" }) }, GREY, 100);
  expect(posted).toHaveLength(0);
  cutter.setVolume({ ...VOLUME, ctId: "ct-2" });
  cutter.update(10, { ...subject(1), channel: channel({ ct_id: "ct-2" }) }, GREY, 100);
  expect(posted).toHaveLength(1);
});
