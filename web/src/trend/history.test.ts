import { expect, test } from "vitest";
import { numbersVerdict, type NumbersVerdict } from "../live/assess";
import { channel, receivedImage, situation, snapshot } from "../live/builders";
import { assessment, figure, headline } from "../live/figureBuilders";
import type { SnapshotMessage } from "../live/messages";
import { isTrendShown, SPAN_MS, TrendHistory } from "./history";

const UNREAD: NumbersVerdict = {
  live: false,
  cause: "unread",
  unread: { known: false, headline: headline() },
  ageMs: 40,
};
const OLD: NumbersVerdict = { live: false, cause: "old", unread: null, ageMs: 400 };
const GONE: NumbersVerdict = { live: false, cause: "server-gone", unread: null, ageMs: 900 };

/** An image captured 40 ms ago with these figures. */
function image(
  nowMs: number,
  figures: { entry?: number; depth?: number; wall?: number | null },
  changes: Partial<SnapshotMessage> = {},
): NumbersVerdict {
  const tools = snapshot().tools.map((tool) => ({
    ...tool,
    assessment: assessment(
      {},
      {
        entry: figure(figures.entry ?? 1, { limit: 1.8 }),
        depth: figure(figures.depth ?? 3, { limit: 40 }),
        wall: figure(figures.wall === undefined ? 2 : figures.wall, { limit: 1 }),
      },
    ),
  }));
  const numbers = receivedImage(nowMs - 40, { tools, image_number: nowMs, ...changes });
  return numbersVerdict(situation({ numbers, lastReceivedAtMs: nowMs }), nowMs);
}

test("an image counts once, at the time when it was grabbed", () => {
  const history = new TrendHistory();
  const numbers = image(1000, { entry: 1.2 });
  history.add(1000, numbers);
  history.add(1050, numbers);
  expect(history.samples.map(({ atMs, figures }) => [atMs, figures?.entry.value])).toEqual([[960, 1.2]]);
});

test("of images that share a sample the worst is kept, and the newest depth", () => {
  const history = new TrendHistory();
  history.add(1000, image(1000, { entry: 1.2, depth: 5, wall: 2 }));
  history.add(1033, image(1033, { entry: 3.1, depth: 6, wall: -0.4 }));
  history.add(1066, image(1066, { entry: 0.4, depth: 7, wall: 1.5 }));
  expect(history.samples).toHaveLength(1);
  expect(history.samples[0]?.figures).toMatchObject({
    entry: { value: 3.1 },
    depth: { value: 7 },
    wall: { value: -0.4 },
  });
});

test("where figures are withheld is a gap, however often that is looked at", () => {
  const history = new TrendHistory();
  history.add(500, UNREAD);
  history.add(1000, image(1000, {}));
  for (const nowMs of [1100, 1150, 1200]) history.add(nowMs, UNREAD);
  history.add(1300, image(1300, {}));
  expect(history.samples.map(({ figures }) => figures !== null)).toEqual([true, false, true]);
});

test("of a minute at 30 images a second half is kept, a sample each 100 ms", () => {
  const history = new TrendHistory();
  for (let nowMs = 1000; nowMs <= 61_000; nowMs += 33) history.add(nowMs, image(nowMs, {}));
  expect(history.samples.length).toBeLessThanOrEqual(SPAN_MS / 100 + 2);
  expect(history.samples[1]?.atMs).toBeGreaterThanOrEqual(61_000 - SPAN_MS - 100);
});

test("figures of another plan are no continuation of these", () => {
  const history = new TrendHistory();
  history.add(1000, image(1000, {}));
  history.add(1200, image(1200, {}, { channel: channel({ radius_mm: 3 }) }));
  expect(history.samples).toHaveLength(1);
});

test("curves are shown while the newest image has figures or a reason, and not when it is too old", () => {
  expect(isTrendShown(image(1000, {}))).toBe(true);
  expect(isTrendShown(UNREAD)).toBe(true);
  expect(isTrendShown(OLD)).toBe(false);
  expect(isTrendShown(GONE)).toBe(false);
});
