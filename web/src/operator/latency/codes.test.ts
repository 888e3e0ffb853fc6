import { expect, test } from "vitest";
import { CodeSequence } from "./codes";

const plan = { patterns: ["a", "b", "c"], codes: 4, min_code_ms: 100, max_code_ms: 150 };

test("a code is shown for between the shortest and the longest time", () => {
  const shortest = new CodeSequence(plan, () => 0);
  expect(shortest.next(1000)).toBe(0);
  expect(shortest.next(1099)).toBeNull();
  expect(shortest.next(1100)).toBe(1);
  const longest = new CodeSequence(plan, () => 1);
  expect(longest.next(1000)).toBe(0);
  expect(longest.next(1149)).toBeNull();
  expect(longest.next(1150)).toBe(1);
});

test("codes restart after the last one, and no number repeats in succession", () => {
  const sequence = new CodeSequence(plan, () => 0);
  expect([0, 100, 200, 300, 400].map((at) => sequence.next(at))).toEqual([0, 1, 2, 0, 1]);
});

test("codes are counted from the first one that the camera has read", () => {
  const sequence = new CodeSequence(plan, () => 0);
  for (let at = 0; at < 5000; at += 100) expect(sequence.next(at)).not.toBeNull();
  expect([sequence.isCounting, sequence.isOver, sequence.doneRatio]).toEqual([false, false, 0]);
  sequence.begin();
  expect(sequence.next(5000)).not.toBeNull();
  sequence.begin();
  expect(sequence.doneRatio).toBe(0.25);
  for (const at of [5100, 5200, 5300]) expect(sequence.next(at)).not.toBeNull();
  expect(sequence.isOver).toBe(true);
  expect(sequence.next(5400)).toBeNull();
});
