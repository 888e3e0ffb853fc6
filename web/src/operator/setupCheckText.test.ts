import { expect, test } from "vitest";
import { setupCheckDe } from "../texts/setupCheck/de";
import { setupCheckEn } from "../texts/setupCheck/en";
import { helpfulRemedies, remedyText, setupSentence, type SetupCheck } from "./setupCheckText";

function error(entry: number, isthmus: number, tolerance: number): SetupCheck["found"] {
  const larger = Math.max(entry, isthmus);
  return {
    entry_95_mm: entry,
    isthmus_95_mm: isthmus,
    error_95_mm: larger,
    tolerance_mm: tolerance,
    suffices: larger <= tolerance,
  };
}

const CHECK: SetupCheck = {
  basis: "registration",
  method: "points",
  vertebra: "L3",
  side: "left",
  diameter_mm: 6.5,
  tool: "drill",
  landmark_sd_mm: null,
  found: error(1.1, 1.2, 0.5),
  remedies: [],
};

test("an insufficient registration is stated with its values", () => {
  expect(setupSentence(CHECK, "left", setupCheckEn)).toBe(
    "L3 left, screw of 6.5 mm: error at the isthmus at least 1.20 mm (95 %), 0.50 mm to the wall. " +
      "The set-up is not sufficient: every image would report SET-UP INSUFFICIENT.",
  );
});

test("the place is that of the larger error, and what suffices is not warned of", () => {
  const text = setupSentence({ ...CHECK, found: error(0.4, 0.3, 0.5) }, "left", setupCheckEn);
  expect(text).toContain("error at the entry at least 0.40 mm");
  expect(text).toContain("The set-up is sufficient for this screw.");
});

test("before a registration the sentence is an expectation", () => {
  const expected: SetupCheck = { ...CHECK, basis: "landmarks", method: null, landmark_sd_mm: 0.7 };
  expect(setupSentence(expected, "left", setupCheckEn)).toBe(
    "L3 left, screw of 6.5 mm: with the planned landmarks, each touched to 0.7 mm (1 SD per axis), and an exact tool, " +
      "an error of 1.20 mm (95 %) is expected at the isthmus, 0.50 mm to the wall. This is not sufficient: " +
      "images would report SET-UP INSUFFICIENT unless the touches are better than assumed.",
  );
});

test.each([
  [
    { kind: "more_landmarks", landmarks: 8, diameter_mm: null, expected: error(0.3, 0.4, 0.5) },
    "8 landmarks, spread like these, none mistaken: 0.40 mm, enough at best.",
  ],
  [
    { kind: "thinner_screw", landmarks: null, diameter_mm: 5, expected: error(1.1, 1.2, 1.25) },
    "Screw of 5.0 mm: 1.25 mm to the wall, enough at best.",
  ],
  [
    { kind: "exact_tool", landmarks: null, diameter_mm: null, expected: error(0.2, 0.3, 0.5) },
    "A tool with an exact tip and axis: 0.30 mm, enough at best.",
  ],
  [
    { kind: "surface_sweep", landmarks: null, diameter_mm: null, expected: null },
    "A surface sweep: the error is known only afterwards.",
  ],
] as const)("a remedy states the error that it would give", (remedy, text) => {
  expect(remedyText(remedy, setupCheckEn)).toBe(text);
  expect(remedyText(remedy, setupCheckDe)).not.toMatch(/[{}]/);
});

test("what is not enough is not listed as help", () => {
  const remedies: SetupCheck["remedies"] = [
    { kind: "more_landmarks", landmarks: 10, diameter_mm: null, expected: error(0.8, 0.9, 0.5) },
    { kind: "surface_sweep", landmarks: null, diameter_mm: null, expected: null },
    { kind: "thinner_screw", landmarks: null, diameter_mm: 5, expected: error(1.1, 1.2, 1.25) },
  ];
  expect(helpfulRemedies({ ...CHECK, remedies }).map((one) => one.kind)).toEqual([
    "surface_sweep",
    "thinner_screw",
  ]);
});
