import { expect, test } from "vitest";
import { snapshot } from "../live/builders";
import { theatreEn } from "../texts/theatre/en";
import { ageText, checkText, registrationText } from "./statusTexts";
import type { Procedure } from "../app/procedure";

type State = Procedure["steps"][number]["state"];

function procedureWith(check: State, checkAgeMin: number | null = 3): Procedure {
  const step = {
    code: "REGISTERED",
    language: "en" as const,
    message: "",
    remedy: "",
    document_id: null,
    allowed: true,
    missing_cosignature: null,
  };
  return {
    case_id: "c1",
    case_name: "Phantom 4",
    next_step: "navigate",
    may_navigate: true,
    confirmation: null,
    setup_check: null,
    recording: null,
    steps: [
      { ...step, step: "register", state: "done", numbers: { age_min: 12.7 } },
      { ...step, step: "check", state: check, numbers: { age_min: checkAgeMin } },
    ],
  };
}

test("states method and age of the registration", () => {
  const by = snapshot({ registered_by: "points" });
  expect(registrationText(by, procedureWith("done"), theatreEn)?.value).toBe("by landmarks, 12 min ago");
  expect(registrationText(by, null, theatreEn)?.value).toBe("by landmarks");
  expect(registrationText(snapshot({ registered_by: null }), procedureWith("done"), theatreEn)).toEqual({
    value: "not registered",
    mood: "bad",
  });
  expect(registrationText(null, procedureWith("done"), theatreEn)).toBeNull();
});

test.each([
  ["done", "3 min ago", "good"],
  ["due", "3 min ago, due again", "bad"],
  ["failed", "failed", "bad"],
  ["missing", "not checked", "bad"],
  ["out_of_date", "not checked", "bad"],
] as const)("a check that is %s is shown as such", (state, value, mood) => {
  expect(checkText(snapshot(), procedureWith(state), theatreEn)).toEqual({ value, mood });
});

test("without an open case no check is shown", () => {
  expect(checkText(snapshot(), { ...procedureWith("missing"), case_id: null }, theatreEn)).toBeNull();
});

test.each([
  [null, ""],
  [-1, ""],
  [0.4, "just now"],
  [59.9, "59 min ago"],
  [150, "2 h ago"],
])("%s minutes are %j", (minutes, said) => {
  expect(ageText(minutes, theatreEn)).toBe(said);
});
