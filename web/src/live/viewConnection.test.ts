import { beforeEach, expect, test } from "vitest";
import { bytes, message } from "./builders";
import { FakeSocket } from "./fakeSocket";
import { ViewConnection, type ViewSocket } from "./viewConnection";

class FakeViewSocket extends FakeSocket implements ViewSocket {
  binaryType: BinaryType = "blob";
}

let sockets: FakeViewSocket[];
let waits: { action: () => void; waitMs: number }[];
let states: string[];
let images: number[];
let connection: ViewConnection;

const newest = (): FakeViewSocket => {
  const socket = sockets.at(-1);
  if (!socket) throw new Error("no socket was opened");
  return socket;
};
/** Advances past the last requested delay. */
const passWait = (waitMs: number): void => {
  const due = waits.filter((wait) => wait.waitMs === waitMs);
  waits = waits.filter((wait) => wait.waitMs !== waitMs);
  for (const { action } of due) action();
};

beforeEach(() => {
  sockets = [];
  waits = [];
  states = [];
  images = [];
  connection = new ViewConnection({
    open: () => {
      sockets.push(new FakeViewSocket());
      return newest();
    },
    later: (action, waitMs) => waits.push({ action, waitMs }),
    onLink: (state) => states.push(state),
    onFrame: (frame) => images.push(frame.message.sequence),
  });
  connection.start();
});

test("requests one image on opening, and no other before it is asked to", () => {
  newest().onopen?.();
  newest().onmessage?.({ data: bytes(message()) });
  expect(newest().sent).toEqual(['{"next":true}']);
  connection.requestNext();
  expect(newest().sent).toHaveLength(2);
  expect(images).toEqual([7]);
});

test("sends with each request the time that the page took, and its limits", () => {
  newest().onopen?.();
  connection.requestNext(41.7);
  connection.limitSize("half");
  connection.limitRate(50);
  expect(newest().sent.slice(1)).toEqual([
    '{"next":true,"showing_ms":42}',
    '{"largest":"half"}',
    '{"interval_ms":50}',
  ]);
});

test("another size is requested on an open connection only", () => {
  connection.askSize("half");
  expect(newest().sent).toEqual([]);
  newest().onopen?.();
  connection.askSize("half");
  expect(newest().sent).toEqual(['{"next":true}', '{"size":"half"}']);
  newest().onclose?.();
  connection.askSize("full");
  expect(newest().sent).toHaveLength(2);
});

test("a lost connection is reported at once and retried", () => {
  newest().onopen?.();
  newest().onclose?.();
  expect(states).toEqual(["open", "lost"]);
  passWait(100);
  expect(sockets).toHaveLength(2);
  newest().onclose?.();
  passWait(200);
  expect(sockets).toHaveLength(3);
});

test("the first message sets the wait back to its shortest", () => {
  newest().onclose?.();
  passWait(100);
  newest().onopen?.();
  newest().onmessage?.({ data: bytes(message()) });
  newest().onclose?.();
  passWait(100);
  expect(sockets).toHaveLength(3);
});

test("a bad message costs the line, and nothing of it is shown", () => {
  newest().onopen?.();
  newest().onmessage?.({ data: new ArrayBuffer(2) });
  expect(images).toEqual([]);
  expect(states).toEqual(["open", "lost"]);
  expect(newest().closed).toBe(true);
});

test("what a lost line still brings is not heard", () => {
  const old = newest();
  old.onopen?.();
  connection.restart();
  expect(old.onmessage).toBeNull();
  expect(old.onclose).toBeNull();
});
