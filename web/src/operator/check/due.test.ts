import { expect, test } from "vitest";
import { minutesLeft } from "./due";

test.each([
  [10, 20],
  [30, 0],
  [45, 0],
  [null, null],
])("a check of %s minutes is due again in %s", (age, left) => {
  expect(minutesLeft(age, 30)).toBe(left);
});
