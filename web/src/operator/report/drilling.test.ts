import { expect, test } from "vitest";
import type { DrillingMessage } from "../../api";
import { reportEn } from "../../texts/report/en";
import { figureText, gradeText, missingText } from "./drilling";

const texts = reportEn.drilling;

test("a figure stands with its own error; a missing one is never shown as zero", () => {
  expect(figureText({ value: -0.8, error_95: 0.17 }, "mm", texts)).toBe("−0.8 ± 0.17 mm");
  expect(figureText({ value: 0.2, error_95: 0.06 }, "°", texts)).toBe("0.2 ± 0.06°");
  expect(figureText({ value: 0.8, error_95: null }, "mm", texts)).toBe("0.8 mm (error unknown)");
  expect(figureText({ value: null, error_95: null }, "mm", texts)).toBe("unknown");
});

const graded = (
  grade: DrillingMessage["grade"],
  worst: DrillingMessage["worst_grade"],
  against: DrillingMessage["against"] = "bone",
): string => gradeText({ grade, worst_grade: worst, against } as DrillingMessage, texts);

test("a grade is stated with the worst one of its interval", () => {
  expect(graded("A", "A")).toBe("A, also at the limit of the 95 % interval of the least clearance");
  expect(graded("A", "B")).toBe("A, up to B within the 95 % interval of the least clearance");
  expect(graded("B", null)).toBe("B (error unknown)");
  expect(graded(null, null, "channel")).toBe("none: the planned channel is not bone");
  expect(graded(null, null, null)).toBe("unknown");
});

test("the time without numbers is stated, also when there was none", () => {
  const drilling = { missing_s: 1.2, longest_missing_s: 0.9 } as DrillingMessage;
  expect(missingText(drilling, texts)).toBe("1.2 s, longest 0.9 s");
  expect(missingText({ ...drilling, missing_s: 0 }, texts)).toBe("never");
});
