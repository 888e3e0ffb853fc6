import { expect, test } from "vitest";
import { caseEn } from "../../texts/case/en";
import { documentTitle } from "./documentTitle";

test.each([
  ["camera", "main", "Calibration of the camera"],
  ["check", "accuracy of the camera", "Check of the camera on known distances"],
  ["check", "registration of L3", "Check of L3 on a landmark"],
  ["check", "tip of drill", "Check of the tip of drill"],
  ["plan", "main", "Plan"],
  ["plan", "active channel", "Channel to be drilled"],
  ["registration", "L3", "Registration of L3"],
  ["signature", "registration L3 by a17", "Co-signature of the registration of L3"],
  ["snapshot", "main", "Snapshot main"],
] as const)("%s “%s” has a readable title", (kind, name, title) => {
  expect(documentTitle({ kind, name }, caseEn)).toBe(title);
});
