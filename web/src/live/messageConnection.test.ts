import { beforeEach, expect, test } from "vitest";
import { message } from "./builders";
import { SilentSocket } from "./fakeSocket";
import { MessageConnection } from "./messageConnection";

let sockets: SilentSocket[];
let waits: (() => void)[];
let received: number[];
let connection: MessageConnection;

const newest = (): SilentSocket => {
  const socket = sockets.at(-1);
  if (!socket) throw new Error("no socket was opened");
  return socket;
};

beforeEach(() => {
  sockets = [];
  waits = [];
  received = [];
  connection = new MessageConnection({
    open: () => {
      sockets.push(new SilentSocket());
      return newest();
    },
    later: (action) => waits.push(action),
    onMessage: ({ sequence }) => received.push(sequence),
  });
  connection.start();
  newest().onopen?.();
});

test("passes each message on", () => {
  for (const sequence of [3, 4]) newest().onmessage?.({ data: JSON.stringify(message({ sequence })) });
  expect(received).toEqual([3, 4]);
});

test.each(["{", "[]", JSON.stringify({ ...message(), sequence: null })])(
  "is opened anew after %s, which is no live message",
  (data) => {
    newest().onmessage?.({ data });
    expect(received).toEqual([]);
    expect(newest().closed).toBe(true);
    for (const action of waits.splice(0)) action();
    expect(sockets).toHaveLength(2);
  },
);

test("is reopened after a loss, and not after it was stopped", () => {
  newest().onclose?.();
  for (const action of waits.splice(0)) action();
  expect(sockets).toHaveLength(2);
  connection.stop();
  expect(newest().closed).toBe(true);
  for (const action of waits.splice(0)) action();
  expect(sockets).toHaveLength(2);
});
