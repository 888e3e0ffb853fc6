import { expect, test } from "vitest";
import { toolRecordFrom, nextPurpose, type KnownTool } from "./toolRecord";

const PIVOT = { rms_3d_mm: 0.21, used: 38, tilt_range_deg: 31 };
const CONTENT = { marker: "drill", side_mm: 25, radius_mm: 2, length_mm: 118, pivot: PIVOT, spin: null };

function tool(content: Record<string, unknown> | null, current = true): KnownTool {
  const heading = { current } as NonNullable<KnownTool["calibration"]>["heading"];
  return {
    name: "drill",
    from_settings: false,
    marker: null,
    radius_mm: null,
    length_mm: null,
    calibration: content === null ? null : { heading, content },
    check: null,
  };
}

test("a pivoted tool has its tip's numbers and no axis", () => {
  expect(toolRecordFrom(CONTENT)).toMatchObject({
    tipRmsMm: 0.21,
    tipPoses: 38,
    tiltDeg: 31,
    hasAxis: false,
    wobbleDeg: null,
  });
});

test("what is not in the document is not known, and nothing breaks by it", () => {
  expect(toolRecordFrom({ pivot: "none", spin: 3, radius_mm: "2" })).toMatchObject({
    tipRmsMm: null,
    radiusMm: null,
    hasAxis: false,
    marker: "",
  });
});

test.each([
  ["never calibrated", tool(null), "pivot"],
  ["calibrated and out of date", tool(CONTENT, false), "pivot"],
  ["pivoted", tool(CONTENT), "spin"],
  ["pivoted, with an axis from the drawing", tool({ ...CONTENT, axis_in_marker: [0, -1, 0] }), "tip_check"],
  ["pivoted and spun", tool({ ...CONTENT, spin: { axis_in_marker: [0, -1, 0] } }), "tip_check"],
])("next, for a tool that was %s", (_, known, next) => {
  expect(nextPurpose(known)).toBe(next);
});
