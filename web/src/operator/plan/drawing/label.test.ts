import { expect, test } from "vitest";
import { labelAt } from "./label";

const NAME = "left transverse process, tip";

test.each([
  ["with room to the right", 100, 500, "1 left transverse process, tip", false],
  ["with room to the left", 400, 500, "1 left transverse process, tip", true],
  ["in the middle of a picture too narrow for either side", 200, 400, "1", false],
  ["in a picture of middle size", 20, 280, "1", false],
] as const)("%s", (_, x, width, text, isLeft) => {
  expect(labelAt(x, width, "1", NAME)).toEqual({ text, isLeft });
});

test("in a small picture nothing is written", () => {
  expect(labelAt(20, 176, "1", NAME)).toBeNull();
});

test("a point beside the slice has its number alone", () => {
  expect(labelAt(100, 800, "7", "")?.text).toBe("7");
});
