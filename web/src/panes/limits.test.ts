import { expect, test } from "vitest";
import { along, judgement, snapshot } from "../live/builders";
import type { DeviationMessage, JudgementMessage } from "../live/messages";
import { readingOf, type Reading } from "../live/reading";
import { figureOf } from "./limits";

function reading(changes: Partial<DeviationMessage> = {}, judged: Partial<JudgementMessage> = {}): Reading {
  const [tool] = snapshot().tools;
  if (tool?.deviation.kind !== "deviation") throw new Error("the builder has a deviation");
  const deviation = { ...tool.deviation, ...changes };
  const read = readingOf(
    snapshot({ tools: [{ ...tool, deviation, judgement: judgement(judged), along: along() }] }),
  );
  if (!read.known) throw new Error("the builder's numbers are known");
  return read;
}

function wallAt(clearance_mm: number): Reading {
  const now = {
    kind: "nearest" as const,
    wall: "medial" as const,
    point_in_vertebra_mm: [0, 0, 0],
    grade: "A" as const,
  };
  return reading({}, { clearance: { ...judgement().clearance, now: { ...now, clearance_mm } } });
}

test("offset and angle are held against what the pedicle leaves", () => {
  expect(figureOf(reading(), "entry", 1)).toEqual({ value: 1, limit: 2, standing: "within" });
  expect(figureOf(reading({ entry_offset_mm: 2.1 }), "entry", 1).standing).toBe("over");
  expect(figureOf(reading({ angle_deg: 6.4 }), "angle", 1)).toEqual({
    value: 6.4,
    limit: 6.3,
    standing: "over",
  });
});

test("a drill across the channel is within no limit", () => {
  expect(figureOf(reading({ entry_offset_mm: null }), "entry", 1).standing).toBe("over");
});

test("depth ends at the planned end", () => {
  expect(figureOf(reading({ depth_mm: 39.9, remaining_mm: 0.1 }), "depth", 1)).toEqual({
    value: 39.9,
    limit: 40,
    standing: "within",
  });
  expect(figureOf(reading({ depth_mm: 40.1, remaining_mm: -0.1 }), "depth", 1).standing).toBe("through");
});

test("a wall is near below the alarm's distance, and gone through below zero", () => {
  expect(figureOf(wallAt(1.0), "wall", 1).standing).toBe("within");
  expect(figureOf(wallAt(0.9), "wall", 1).standing).toBe("over");
  expect(figureOf(wallAt(-0.1), "wall", 1).standing).toBe("through");
  // Before the server has said its limit, nothing is called near by one that the page made up.
  expect(figureOf(wallAt(0.5), "wall", null)).toEqual({ value: 0.5, limit: null, standing: "within" });
});

test("without a judgement nothing has a limit and no wall is claimed", () => {
  const unjudged: Reading = { ...reading(), judgement: null };
  expect(figureOf(unjudged, "entry", 1)).toEqual({ value: 1, limit: null, standing: "within" });
  expect(figureOf(unjudged, "wall", 1).value).toBeNull();
});
