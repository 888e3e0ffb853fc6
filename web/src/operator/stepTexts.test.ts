import { expect, test } from "vitest";
import { en } from "../texts/en";
import { operatorEn } from "../texts/operator/en";
import { stateText, stepNote } from "./stepTexts";

test.each([
  ["navigate", "done", "ready"],
  ["navigate", "missing", "to do"],
  ["plan", "done", "done"],
  ["check", "due", "due again"],
] as const)("%s that the server calls %s reads %s", (step, state, expected) => {
  expect(stateText({ step, state }, operatorEn)).toBe(expected);
});

test.each([
  ["plan", "done", 0, 3, true],
  ["plan", "done", 2, 3, true],
  ["plan", "done", 3, 3, false],
  ["plan", "done", 0, null, false],
  ["plan", "missing", 0, 3, false],
  ["register", "done", 0, 3, false],
] as const)("%s, %s, with %s of %s landmarks", (step, state, landmarks, minLandmarks, isShown) => {
  const note = stepNote({ step, state, numbers: { landmarks } }, minLandmarks, en);
  expect(note !== "").toBe(isShown);
  if (isShown) expect(note).toContain(`${String(landmarks)} landmarks`);
});
