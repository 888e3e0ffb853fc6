import { beforeEach, expect, test } from "vitest";
import { LONGEST_WAIT_MS, waitBeforeMs } from "./backoff";
import { SilentSocket } from "./fakeSocket";
import { ANSWER_WITHIN_MS, ReconnectingSocket } from "./reconnectingSocket";

let sockets: SilentSocket[];
let waits: { action: () => void; waitMs: number }[];
let events: string[];
let reconnecting: ReconnectingSocket<SilentSocket>;

const newest = (): SilentSocket => {
  const socket = sockets.at(-1);
  if (!socket) throw new Error("no socket was opened");
  return socket;
};
/** Advances past the last requested delay and returns it. */
const passLastWait = (): number => {
  const last = waits.pop();
  last?.action();
  return last?.waitMs ?? Number.NaN;
};
/** Advances past the delay after a loss and opens the next connection. */
const loseAndWait = (): number => {
  newest().onclose?.();
  return passLastWait();
};

beforeEach(() => {
  sockets = [];
  waits = [];
  events = [];
  reconnecting = new ReconnectingSocket<SilentSocket>({
    open: () => {
      sockets.push(new SilentSocket());
      return newest();
    },
    later: (action, waitMs) => waits.push({ action, waitMs }),
    onOpen: () => events.push("open"),
    onData: (data) => {
      events.push(String(data));
      if (data === "bad") reconnecting.reconnect();
      else reconnecting.markReceived();
    },
    onLost: () => events.push("lost"),
  });
  reconnecting.start();
});

test("waits grow, and never over half a second", () => {
  expect([0, 1, 2, 3, 50].map(waitBeforeMs)).toEqual([100, 200, 400, 500, LONGEST_WAIT_MS]);
  expect([1, 2, 3, 4, 5].map(loseAndWait)).toEqual([100, 200, 400, 500, 500]);
  expect(sockets).toHaveLength(6);
});

test("what is heard sets the wait back to its shortest; to be open is not enough", () => {
  expect([loseAndWait(), loseAndWait()]).toEqual([100, 200]);
  newest().onopen?.();
  expect(loseAndWait()).toBe(400);
  newest().onopen?.();
  newest().onmessage?.({ data: "good" });
  expect(loseAndWait()).toBe(100);
});

test("it is open from its opening until its loss", () => {
  expect([reconnecting.socket === newest(), reconnecting.openSocket]).toEqual([true, null]);
  newest().onopen?.();
  expect(reconnecting.openSocket).toBe(newest());
  newest().onclose?.();
  expect([reconnecting.socket, reconnecting.openSocket, reconnecting.hasReceived]).toEqual([
    null,
    null,
    false,
  ]);
  expect(events).toEqual(["open", "lost"]);
});

test("what cannot be understood costs the line", () => {
  newest().onopen?.();
  newest().onmessage?.({ data: "bad" });
  expect(events).toEqual(["open", "bad", "lost"]);
  expect(newest().closed).toBe(true);
  expect(passLastWait()).toBe(100);
  expect(sockets).toHaveLength(2);
});

test("a server that takes the call and never answers is left, one that answered is not", () => {
  const [answer] = waits;
  expect(answer?.waitMs).toBe(ANSWER_WITHIN_MS);
  answer?.action();
  expect(events).toEqual(["lost"]);
  passLastWait();
  newest().onopen?.();
  waits.at(-1)?.action();
  expect(events).toEqual(["lost", "open"]);
  // The first socket's timer must not affect the second.
  answer?.action();
  expect(sockets).toHaveLength(2);
});

test("a lost line is not heard, and is lost once", () => {
  const old = newest();
  old.onopen?.();
  reconnecting.reconnect();
  expect([old.onopen, old.onmessage, old.onclose, old.closed]).toEqual([null, null, null, true]);
  expect(events).toEqual(["open", "lost"]);
});

test("a stopped connection stays closed, and a started one reconnects", () => {
  newest().onclose?.();
  reconnecting.stop();
  passLastWait();
  reconnecting.reconnect();
  expect(sockets).toHaveLength(1);
  reconnecting.start();
  expect(sockets).toHaveLength(2);
  reconnecting.stop();
  expect(newest().closed).toBe(true);
  expect(events).toEqual(["lost"]);
});
