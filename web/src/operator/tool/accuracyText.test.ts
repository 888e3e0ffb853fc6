import { expect, test } from "vitest";
import type { AccuracyTestMessage } from "../../api";
import { certificateDe } from "../../texts/certificate/de";
import { certificateEn } from "../../texts/certificate/en";
import { accuracyText, placementText } from "./accuracyText";

const EN = certificateEn.guided;
const DE = certificateDe.guided;
const DUE = { placement: "far", divot: "3", posture: "tilted" };
const BEGUN: AccuracyTestMessage = {
  tool: "drill",
  marker: "drill",
  plate: "A4-3x3",
  divots: [{ name: "3", x_mm: 120, y_mm: 0, taken: 0 }],
  planned: 54,
  taken: 27,
  due: DUE,
  last: null,
  capture: null,
  error_95_mm: null,
  problems: [],
};
const LOOKING = { ...DUE, state: "looking", seen: 4, images: 5, problem: null } as const;
const PROBLEM = {
  code: "ACCURACY_TIP_OFFSET",
  message: "m",
  remedy: "r",
  context: {},
  language: "en",
} as const;

test.each([
  ["the posture that is due", BEGUN, "Divot 3: tilt the tool by about 30° with its tip in it, then capture."],
  [
    "an active capture, and not the next one",
    { ...BEGUN, capture: LOOKING },
    "Divot 3: hold still. 4 of 5 images with the tip.",
  ],
  [
    "a rejected capture: the same one is due",
    { ...BEGUN, capture: { ...LOOKING, state: "rejected" as const } },
    "Divot 3: tilt the tool by about 30° with its tip in it, then capture.",
  ],
  [
    "a complete test",
    { ...BEGUN, due: null, error_95_mm: 0.7 },
    "All captures are taken: nothing speaks against a certificate of 0.70 mm.",
  ],
  [
    "a refused test, without its figure",
    { ...BEGUN, due: null, error_95_mm: 0.7, problems: [PROBLEM] },
    "All captures are taken, and the test is refused:",
  ],
  [
    "a test that could not be assessed",
    { ...BEGUN, due: null },
    "All captures are taken, and the test is refused:",
  ],
])("%s", (_, state, sentence) => {
  expect(accuracyText(state, EN)).toBe(sentence);
});

test("German has the same values", () => {
  expect(accuracyText({ ...BEGUN, capture: LOOKING }, DE)).toBe(
    "Mulde 3: stillhalten. 4 von 5 Bildern mit der Spitze.",
  );
});

test("the plate is moved before the first capture of a placement only", () => {
  expect(placementText(BEGUN, EN)).toBe(EN.place.far);
  const divots = BEGUN.divots.map((one) => ({ ...one, taken: 1 }));
  expect(placementText({ ...BEGUN, divots }, EN)).toBeNull();
});
