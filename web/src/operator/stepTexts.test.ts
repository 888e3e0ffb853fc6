import { expect, test } from "vitest";
import { en } from "../texts/en";
import { operatorEn } from "../texts/operator/en";
import { stateText, stepNote } from "./stepTexts";

test.each([
  ["navigate", "done", "NAVIGATION_ALLOWED", "ready"],
  ["navigate", "missing", "WAITS_FOR_STEP", "to do"],
  ["plan", "done", "CHANNEL_SELECTED", "done"],
  ["plan", "missing", "NOT_PLANNED", "to do"],
  ["plan", "missing", "PLAN_OF_REHEARSAL", "rehearsal's own"],
  ["check", "due", "CHECK_DUE", "due again"],
] as const)("%s that the server calls %s for %s reads %s", (step, state, code, expected) => {
  expect(stateText({ step, state, code }, operatorEn)).toBe(expected);
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
