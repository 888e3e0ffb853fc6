import { expect, test } from "vitest";
import { FakeSocket } from "../live/fakeSocket";
import { RoomConnection, SILENT_AFTER_MS, type RoomSocket } from "./roomConnection";

class Fake extends FakeSocket implements RoomSocket {
  bufferedAmount = 0;
}

function theatre() {
  const sockets: Fake[] = [];
  const later: [() => void, number][] = [];
  const heard: unknown[] = [];
  const line: boolean[] = [];
  const clock = { nowMs: 0 };
  const room = new RoomConnection({
    open: () => {
      const socket = new Fake();
      sockets.push(socket);
      return socket;
    },
    later: (action, waitMs) => later.push([action, waitMs]),
    now: () => clock.nowMs,
    onMessage: (message) => heard.push(message),
    onConnection: (isConnected) => line.push(isConnected),
  });
  room.start();
  const newest = (): Fake => sockets.at(-1) ?? new Fake();
  return { room, sockets, newest, later, heard, line, clock };
}

test("each message is granted after it was dealt with", () => {
  const { newest, heard, line } = theatre();
  newest().onopen?.();
  expect(newest().sent).toEqual(['{"next":true}']);
  newest().onmessage?.({ data: '{"you":1}' });
  expect(heard).toEqual([{ you: 1 }]);
  expect(line).toEqual([true]);
  expect(newest().sent).toHaveLength(2);
});

test("a lost connection is retried, at first at once, then with increasing delay", () => {
  const { sockets, newest, later, line } = theatre();
  newest().onclose?.();
  expect(line).toEqual([false]);
  later.pop()?.[0]();
  newest().onclose?.();
  expect(sockets).toHaveLength(2);
  expect(later.pop()?.[1]).toBe(200);
});

test("a silent open connection is closed", () => {
  const { room, newest, line, clock } = theatre();
  newest().onopen?.();
  newest().onmessage?.({ data: "{}" });
  clock.nowMs = SILENT_AFTER_MS;
  room.checkTimeout();
  expect(line).toEqual([true]);
  clock.nowMs += 1;
  room.checkTimeout();
  expect(line).toEqual([true, false]);
  expect(newest().closed).toBe(true);
});

test("what is marked does not wait in a full line", () => {
  const { room, newest } = theatre();
  newest().onopen?.();
  newest().onmessage?.({ data: "{}" });
  expect(room.send({ undo: true })).toBe(true);
  newest().bufferedAmount = 5000;
  expect(room.send({ undo: true })).toBe(false);
  newest().onclose?.();
  expect(room.send({ undo: true })).toBe(false);
});
