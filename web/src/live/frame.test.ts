import { expect, test } from "vitest";
import { bytes, message } from "./builders";
import { BadFrame, frameFromBytes } from "./frame";

test("header and picture are split at the stated length", () => {
  const frame = frameFromBytes(bytes(message({ sequence: 12 }), [1, 2, 3]));
  expect(frame.message.sequence).toBe(12);
  expect([...frame.jpeg]).toEqual([1, 2, 3]);
});

test("an empty picture is a message without one", () => {
  expect(frameFromBytes(bytes(message({ snapshot: null }))).jpeg.byteLength).toBe(0);
});

test.each([
  ["nothing", new ArrayBuffer(0)],
  ["less than a length", new ArrayBuffer(3)],
  ["a header of no bytes", bytes(message(), [], 0)],
  ["a header longer than the message", bytes(message(), [], 1_000_000)],
  ["a header cut short", bytes(message(), [], 20)],
  [
    "a header that takes a bite of the picture",
    bytes(message(), [1, 2], JSON.stringify(message()).length + 1),
  ],
  ["no JSON", bytes("hello")],
  ["JSON of something else", bytes({ sequence: 1 })],
  ["an age that is not a number", bytes(message({ image_age_ms: null }))],
])("%s is refused", (_, buffer) => {
  expect(() => frameFromBytes(buffer)).toThrow(BadFrame);
});
