import { expect, test } from "vitest";
import { endNear, nextEnd, withEnd, type Mark } from "./marks";

const MARKS: Mark[] = [
  { entry_px: [100, 400], head_px: [120, 200] },
  { entry_px: [300, 400], head_px: [300, 200] },
];

test("the bone's end is asked for, then the head, needle after needle", () => {
  expect(nextEnd([], null, 3)).toEqual({ needle: 0, end: "entry_px" });
  expect(nextEnd([], [1, 2], 3)).toEqual({ needle: 0, end: "head_px" });
  expect(nextEnd(MARKS, null, 3)).toEqual({ needle: 2, end: "entry_px" });
  expect(nextEnd(MARKS, null, 2)).toBeNull();
});

test("the nearest end is grabbed, but only within the tolerance", () => {
  expect(endNear(MARKS, [310, 215], 40)).toEqual({ needle: 1, end: "head_px" });
  expect(endNear(MARKS, [200, 300], 40)).toBeNull();
});

test("one end moves, and nothing else", () => {
  expect(withEnd(MARKS, { needle: 0, end: "head_px" }, [121, 199])).toEqual([
    { entry_px: [100, 400], head_px: [121, 199] },
    MARKS[1],
  ]);
});
