import { expect, test } from "vitest";
import { snapshot } from "../live/builders";
import { headline } from "../live/figureBuilders";
import { readingOf, type Reading } from "../live/reading";
import { en } from "../texts/en";
import { splitOf } from "./splitText";

function reading(): Reading {
  const read = readingOf(snapshot(), headline());
  if (!read.known) throw new Error("the builder's numbers are known");
  return read;
}

test("each component has its direction, medial-lateral and cranial-caudal", () => {
  expect(splitOf(reading(), "entry", en)).toEqual(["0.6 mm lateral", "0.8 mm cranial"]);
  expect(splitOf(reading(), "angle", en)).toEqual(["1.5° medial", "1.5° caudal"]);
});

test("components that round to zero have no direction, and unknown ones no text", () => {
  const base = reading();
  const deviation = { ...base.deviation, entry_lateral_mm: -0.04, entry_cranial_mm: null };
  expect(splitOf({ ...base, deviation }, "entry", en)).toEqual(["0.0 mm", ""]);
});
