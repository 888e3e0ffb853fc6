import { expect, test } from "vitest";
import { namesOf } from "./maskNames";

test.each([
  [["vertebrae_L3.nii.gz"], "1:L3"],
  [["vertebrae_T12.nii"], "1:T12"],
  [["segmentation.nii.gz"], ""],
  [["vertebrae_L3.nii.gz", "vertebrae_L4.nii.gz"], ""],
  [[], ""],
])("%j is sent with the names %j", (names, sent) => {
  expect(namesOf(names.map((name) => ({ name })))).toBe(sent);
});
