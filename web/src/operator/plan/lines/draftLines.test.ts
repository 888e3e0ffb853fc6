import { expect, test } from "vitest";
import { areSame, draftLines } from "./draftLines";

test("the lines run back and forth through the middle and beside it, the left one on the patient's left", () => {
  const lines = draftLines([1, 2, 3], 20);
  expect(lines.map((one) => one.name)).toEqual(["middle", "left", "right"]);
  expect(lines[1]?.ends_lps_mm).toEqual([
    [21, -48, 3],
    [21, 62, 3],
  ]);
});

test("lines are where they were laid until middle or distance is another", () => {
  const laid = draftLines([1, 2, 3], 20);
  expect(areSame(draftLines([1.01, 2, 3], 20), laid)).toBe(true);
  expect(areSame(draftLines([1, 2, 3], 20.5), laid)).toBe(false);
  expect(areSame(draftLines([1, 2, 4], 20), laid)).toBe(false);
  expect(areSame(laid, [])).toBe(false);
});
