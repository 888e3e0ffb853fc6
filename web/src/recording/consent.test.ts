import { expect, test } from "vitest";
import { isAskedUnbidden, isConsented, type Consent } from "./consent";
import { recording } from "./recordingBuilder";

const consent = (state: Consent["state"]): Consent => ({ state, answered_at: null, answered_by: null });

test.each([
  ["given", true],
  ["not_required", true],
  ["not_asked", false],
  ["not_given", false],
] as const)("with consent %s a recording may start: %s", (state, may) => {
  expect(isConsented(consent(state))).toBe(may);
});

test.each([
  ["navigating", "not_asked", true],
  ["navigating", "not_given", false],
  ["navigating", "given", false],
  ["manual", "not_asked", false],
  ["never", "not_asked", false],
] as const)("recordings %s with consent %s: asked unbidden %s", (when, state, asked) => {
  expect(isAskedUnbidden(recording({ when, consent: consent(state) }))).toBe(asked);
});
