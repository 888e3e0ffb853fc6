import { beforeEach, expect, test } from "vitest";
import { FIRST_PICTURE_WITHIN_MS } from "./assess";
import { message } from "./builders";
import { REACHED_WITHIN_MS } from "./firstMessage";
import { Live } from "./live";

let nowMs: number;
let live: Live;

beforeEach(() => {
  nowMs = 1000;
  live = new Live(() => nowMs);
  live.setDraw(() => Promise.resolve(true));
  live.setLink("open");
});

const cause = (): string => {
  const { video, numbers } = live.update();
  if (video.live || numbers.live) throw new Error("nothing can be live before the first message");
  expect(numbers.cause).toBe(video.cause);
  return video.cause;
};

test("silence, lost lines and new ones claim nothing until the grace time is over", () => {
  nowMs += 900; // open, and silent for longer than the server's limit
  expect(cause()).toBe("connecting");
  live.setLink("lost");
  expect(cause()).toBe("connecting");
  live.setLink("open");
  nowMs = 1000 + REACHED_WITHIN_MS;
  expect(live.update()).toMatchObject({ firstMessage: "awaited" });
  expect(cause()).toBe("connecting");
  nowMs += 1;
  expect(live.update()).toMatchObject({ firstMessage: "overdue" });
  expect(cause()).toBe("not-reached");
  live.setLink("lost");
  expect(cause()).toBe("not-reached");
});

test("a server that answers but has no image yet is reached", () => {
  nowMs = 1000 + REACHED_WITHIN_MS;
  live.receiveAnswer(null, nowMs, live.currentGeneration);
  nowMs += REACHED_WITHIN_MS;
  expect(cause()).toBe("connecting");
  nowMs += 1;
  expect(cause()).toBe("not-reached");
});

test("time in the background does not count", () => {
  live.setHidden(true);
  nowMs += 10 * REACHED_WITHIN_MS;
  expect(cause()).toBe("hidden");
  live.setHidden(false);
  expect(cause()).toBe("connecting");
  nowMs += REACHED_WITHIN_MS + 1;
  expect(cause()).toBe("not-reached");
});

test("the first message ends loading, even a late one; then a silent server counts as lost", async () => {
  nowMs += REACHED_WITHIN_MS + 1;
  await live.receive({ message: message(), jpeg: new Uint8Array([1]) });
  expect(live.update()).toMatchObject({ firstMessage: "received", numbers: { live: true } });
  live.setLink("lost");
  expect(cause()).toBe("server-gone");
  live.setHidden(true);
  live.setHidden(false);
  expect(cause()).toBe("server-gone");
  expect(live.update()).toMatchObject({ firstMessage: "received" });
});

test("the page is loading until the first picture is displayed, and live in the next update", async () => {
  let done: (drawn: boolean) => void = () => undefined;
  live.setDraw(() => new Promise((resolve) => (done = resolve)));
  const taking = live.receive({ message: message(), jpeg: new Uint8Array([1]) });
  expect(cause()).toBe("connecting");
  done(true);
  await taking;
  expect(live.update()).toMatchObject({ video: { live: true }, numbers: { live: true } });
});

test("a new canvas waits for its first picture for a limited time", async () => {
  live.setDraw(() => Promise.resolve(false)); // no canvas yet
  await live.receive({ message: message(), jpeg: new Uint8Array([1]) });
  nowMs += 50;
  live.setDraw(() => Promise.resolve(true));
  expect(live.update()).toMatchObject({ video: { cause: "connecting" }, numbers: { live: true } });
  live.receiveAnswer(null, (nowMs += FIRST_PICTURE_WITHIN_MS), live.currentGeneration);
  expect(live.update().video).toMatchObject({ cause: "connecting" });
  live.receiveAnswer(null, (nowMs += 1), live.currentGeneration);
  expect(live.update().video).toMatchObject({ cause: "no-picture" });
});

test("a picture removed for its age does not count as waiting for a first one", async () => {
  await live.receive({ message: message(), jpeg: new Uint8Array([1]) });
  live.receiveAnswer(null, (nowMs += 600), live.currentGeneration);
  live.update();
  expect(live.update().video).toMatchObject({ cause: "old", ageMs: 620 });
  live.setLink("lost");
  live.setLink("open");
  expect(live.update().video).toMatchObject({ ageMs: null });
});
