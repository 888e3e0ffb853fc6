import { beforeEach, expect, test } from "vitest";
import { LONGEST_WAIT_MS } from "../live/backoff";
import type { CameraFacts, Note, ServerMessage } from "./messages";
import { PhoneConnection, QUIET_MS, type PhoneSocket } from "./phoneConnection";

class FakeSocket implements PhoneSocket {
  onopen: (() => void) | null = null;
  onmessage: ((event: { data: unknown }) => void) | null = null;
  onclose: (() => void) | null = null;
  bufferedAmount = 0;
  sent: (string | ArrayBuffer)[] = [];
  closed = false;
  send(data: string | ArrayBuffer): void {
    this.sent.push(data);
  }
  close(): void {
    this.closed = true;
  }
  hear(message: ServerMessage): void {
    this.onmessage?.({ data: JSON.stringify(message) });
  }
  get texts(): unknown[] {
    return this.sent.filter((one) => typeof one === "string").map((text) => JSON.parse(text) as unknown);
  }
}

const WELCOME = {
  width_px: 1280,
  height_px: 720,
  rate_hz: 30,
  quality_ratio: 0.9,
  part_bytes: 10,
  lock_focus: true,
  focus_mm: null,
};
const FACTS: CameraFacts = {
  label: "back",
  width_px: 1280,
  height_px: 720,
  rate_hz: 30,
  focus: "automatic",
  focus_mm: null,
  zoom_percent: null,
};
const TIME = { captured_ms: 5, clock: "capture" } as const;
const noteOf = (credit: number, ping = 0): { note: Note } => ({
  note: {
    ping,
    credit,
    images: 0,
    rate_hz: 0,
    delay_ms: null,
    clock_error_ms: null,
    source_state: null,
    problem: null,
  },
});

let sockets: FakeSocket[];
let waits: { action: () => void; waitMs: number }[];
let events: string[];
let nowMs: number;
let connection: PhoneConnection;

const newest = (): FakeSocket => {
  const socket = sockets.at(-1);
  if (!socket) throw new Error("no socket was opened");
  return socket;
};
/** Advances past the wait before the next attempt, but not past the timeout of an attempt. */
const tryAgain = (): void => {
  const due = waits.filter(({ waitMs }) => waitMs <= LONGEST_WAIT_MS);
  waits = [];
  for (const { action } of due) action();
};
const open = (): FakeSocket => {
  newest().onopen?.();
  newest().hear({ welcome: WELCOME });
  return newest();
};

beforeEach(() => {
  sockets = [];
  waits = [];
  events = [];
  nowMs = 1000;
  connection = new PhoneConnection("k", {
    open: () => {
      sockets.push(new FakeSocket());
      return newest();
    },
    later: (action, waitMs) => waits.push({ action, waitMs }),
    nowMs: () => nowMs,
    onWelcome: () => events.push("welcome"),
    onNote: (note) => events.push(`credit ${String(note.credit)}`),
    onRejected: (problem) => events.push(problem.code),
    onLost: () => events.push("lost"),
  });
  connection.start();
});

test("identifies itself, answers a ping at once with its clock, and waits for credit", () => {
  const socket = open();
  connection.describe(FACTS);
  expect(connection.isFree).toBe(false);
  nowMs = 1234.5;
  socket.hear(noteOf(2, 7));
  expect(socket.texts).toEqual([
    { hello: { key: "k" } },
    { camera: FACTS },
    { pong: { ping: 7, at_ms: 1234.5 } },
  ]);
  expect(connection.isFree).toBe(true);
});

test("sends an image as its head and parts of the size that the server takes", () => {
  const socket = open();
  connection.describe(FACTS);
  socket.hear(noteOf(2));
  socket.sent = [];
  const jpeg = Uint8Array.from({ length: 25 }, (_, at) => at);
  expect(connection.send(jpeg.buffer, TIME)).toBe(true);
  const [head, ...parts] = socket.sent;
  expect(head).toBe('{"image":{"bytes":25,"captured_ms":5,"clock":"capture"}}');
  expect(parts.map((part) => (part as ArrayBuffer).byteLength)).toEqual([10, 10, 5]);
  expect(parts.flatMap((part) => [...new Uint8Array(part as ArrayBuffer)])).toEqual([...jpeg]);
});

test("sends no more than was granted, and nothing behind an image that still waits here", () => {
  const socket = open();
  connection.describe(FACTS);
  socket.hear(noteOf(2));
  expect(connection.send(new ArrayBuffer(1), TIME)).toBe(true);
  socket.bufferedAmount = 1;
  expect(connection.isFree).toBe(false);
  socket.bufferedAmount = 0;
  expect(connection.isFree).toBe(true);
  connection.send(new ArrayBuffer(1), TIME);
  expect(connection.isFree).toBe(false);
  expect(connection.send(new ArrayBuffer(1), TIME)).toBe(false);
  socket.hear(noteOf(3));
  expect(connection.isFree).toBe(true);
});

test("describes its camera before the first image, after a change, and on each new line", () => {
  connection.describe(FACTS);
  const first = open();
  connection.describe({ ...FACTS });
  connection.describe({ ...FACTS, focus: "locked" });
  expect(first.texts.slice(1)).toEqual([{ camera: FACTS }, { camera: { ...FACTS, focus: "locked" } }]);
  first.onclose?.();
  expect(events).toEqual(["welcome", "lost"]);
  tryAgain();
  expect(open().texts.at(-1)).toEqual({ camera: { ...FACTS, focus: "locked" } });
});

test("an image of before a loss is not sent on the new line without credit", () => {
  open().hear(noteOf(2));
  connection.describe(FACTS);
  newest().onclose?.();
  tryAgain();
  open();
  expect(connection.send(new ArrayBuffer(1), TIME)).toBe(false);
});

test("a rejection is reported and not retried", () => {
  newest().onopen?.();
  newest().hear({ rejected: { code: "PHONE_TAKEN", message: "", remedy: "" } });
  tryAgain();
  expect(events).toEqual(["PHONE_TAKEN"]);
  expect(sockets).toHaveLength(1);
  expect(newest().closed).toBe(true);
});

test("a silent server or an invalid message leads to a reconnect", () => {
  const socket = open();
  nowMs += QUIET_MS;
  connection.checkTimeout();
  expect(socket.closed).toBe(false);
  nowMs += 1;
  connection.checkTimeout();
  expect(socket.closed).toBe(true);
  tryAgain();
  newest().onopen?.();
  newest().onmessage?.({ data: "?" });
  expect(newest().closed).toBe(true);
  expect(events).toEqual(["welcome", "lost", "lost"]);
});
