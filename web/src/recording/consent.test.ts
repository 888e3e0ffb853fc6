import { expect, test } from "vitest";
import { isConsentPromptDue, isConsented, type Consent } from "./consent";
import { recording } from "./recordingBuilder";

const consent = (state: Consent["state"]): Consent => ({ state, answered_at: null, answered_by: null });

test.each([
  ["given", true],
  ["not_required", true],
  ["not_answered", false],
  ["not_given", false],
] as const)("with consent %s a recording may start: %s", (state, may) => {
  expect(isConsented(consent(state))).toBe(may);
});

test.each([
  ["navigating", "not_answered", true],
  ["navigating", "not_given", false],
  ["navigating", "given", false],
  ["manual", "not_answered", false],
  ["never", "not_answered", false],
] as const)("recordings %s with consent %s: prompt due %s", (when, state, expected) => {
  expect(isConsentPromptDue(recording({ when, consent: consent(state) }))).toBe(expected);
});
