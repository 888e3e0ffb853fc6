import { expect, test } from "vitest";
import { judgement } from "../live/builders";
import { en } from "../words/en";
import { VERDICT_SYMBOL, aheadText, clearanceMm, verdictText, wallHint } from "./verdictText";

test("an unsure drill is told with the larger uncertainty and what the pedicle leaves", () => {
  const certain = { enough: false, entry_95_mm: 1.2, isthmus_95_mm: 1.94, room_mm: 1.5, room_deg: 6.3 };
  expect(verdictText(judgement({ verdict: "unsure", certain }), en)).toBe("UNSURE ±1.9 of 1.5 mm");
});

test("a drill across the channel has no uncertainty in mm", () => {
  const certain = { enough: false, entry_95_mm: null, isthmus_95_mm: 1, room_mm: 1.5, room_deg: 6.3 };
  expect(verdictText(judgement({ verdict: "unsure", certain }), en)).toBe("UNSURE ±-- of 1.5 mm");
});

test("every verdict has a shape of its own", () => {
  expect(new Set(Object.values(VERDICT_SYMBOL)).size).toBe(4);
});

test("what comes is told with its class", () => {
  expect(aheadText(judgement(), en)).toBe(
    "Through the wall: now 0 %, in 2 mm 3 %, at the end 12 % · at the end class B",
  );
});

test("the nearest wall is named, and a drill outside has none", () => {
  expect(wallHint(judgement(), en)).toBe("medial · to the bone · in 2 mm 0.9 mm");
  const { clearance } = judgement();
  const outside = judgement({ clearance: { ...clearance, now: { kind: "not-entered" } } });
  expect(wallHint(outside, en)).toBe("not in the bone");
  expect(clearanceMm(outside.clearance.now)).toBeNull();
});
