import { expect, test } from "vitest";
import { alarm, alarms } from "../../live/alarmBuilders";
import type { NumbersVerdict } from "../../live/assess";
import { headline, figure, assessment } from "../../live/figureBuilders";
import { snapshot } from "../../live/builders";
import { readingOf } from "../../live/reading";
import type { Layout } from "./layout";
import { PhaseDetector, phaseOf } from "./phase";

test.each<[string, number, number, Layout, string]>([
  ["far above the entry", -50, 3, "overview", "approach"],
  ["far beside the entry", 1, 40, "overview", "approach"],
  ["near the entry", -10, 5, "overview", "align"],
  ["between both bounds of align, coming", -25, 0, "approach", "approach"],
  ["between both bounds of align, leaving", -25, 0, "align", "align"],
  ["just in the bone, coming", 1, 0, "align", "align"],
  ["just in the bone, drilled before", 1, 0, "drill", "drill"],
  ["in the bone", 2, 1, "align", "drill"],
  ["withdrawn", -1, 0, "drill", "align"],
  ["deep, but beside the channel", 15, 12, "approach", "align"],
  ["deep, and drilled a little beside the channel", 15, 12, "drill", "drill"],
])("%s", (_where, depth_mm, tip_offset_mm, shown, phase) => {
  expect(phaseOf({ depth_mm, tip_offset_mm }, shown)).toBe(phase);
});

/** Live figures of a drill at this depth on the axis. */
function at(depth_mm: number, entry: number | null = 1, wall = figure(1.8, { limit: 1 })): NumbersVerdict {
  const image = snapshot();
  const [tool] = image.tools;
  if (tool?.deviation.kind !== "deviation") throw new Error("the builder's tool has a deviation");
  const deviation = { ...tool.deviation, depth_mm, tip_offset_mm: 0 };
  const tools = [{ ...tool, deviation, assessment: assessment({}, { entry: figure(entry), wall }) }];
  const reading = readingOf({ ...image, tools }, headline());
  if (!reading.known) throw new Error("the builder's figures are known");
  return { live: true, reading, imageNumber: 1, ageMs: 0, snapshot: image };
}

const QUIET = { known: true, alarms: alarms() } as const;
const WITHHELD: NumbersVerdict = { live: false, cause: "unread", unread: null, ageMs: 0 };

test("follows the drill only after it has stayed in its phase", () => {
  const detector = new PhaseDetector();
  const update = (nowMs: number, depth: number) =>
    detector.update({ nowMs, numbers: at(depth), alarms: QUIET }, "align");
  expect(update(0, 5)).toBeNull();
  expect(update(900, 5)).toBeNull();
  // Withdrawn in between: the time counts from the next entry.
  expect(update(950, -5)).toBeNull();
  expect(update(1000, 5)).toBeNull();
  expect(update(1999, 5)).toBeNull();
  expect(update(2000, 5)).toBe("drill");
});

test("follows a drill outside the bone, where there is no wall", () => {
  const detector = new PhaseDetector();
  const numbers = at(-50, 1, figure(null, { status: "outside" }));
  detector.update({ nowMs: 0, numbers, alarms: QUIET }, "overview");
  expect(detector.update({ nowMs: 1000, numbers, alarms: QUIET }, "overview")).toBe("approach");
});

test.each([
  ["an alarm is listed", at(5), { known: true, alarms: alarms({ alarms: [alarm({ state: "latched" })] }) }],
  ["alarms are unknown", at(5), { known: false, everReceived: true }],
  ["figures are withheld", WITHHELD, QUIET],
  ["a figure is missing", at(5, null), QUIET],
] as const)("changes nothing while %s", (_what, numbers, alarms) => {
  const detector = new PhaseDetector();
  detector.update({ nowMs: 0, numbers: at(5), alarms: QUIET }, "align");
  expect(detector.update({ nowMs: 5000, numbers, alarms }, "align")).toBeNull();
  // What came before does not count.
  expect(detector.update({ nowMs: 5050, numbers: at(5), alarms: QUIET }, "align")).toBeNull();
});
