import { expect, test } from "vitest";
import { alarm, alarms } from "../live/alarmBuilders";
import type { AlarmsVerdict } from "../alarms/verdict";
import type { NumbersVerdict } from "../live/assess";
import { snapshot } from "../live/builders";
import { assessment, figure, headline } from "../live/figureBuilders";
import type { FigureMessage } from "../live/messages";
import { readingOf } from "../live/reading";
import { HOME_HZ, toneOf } from "./tone";

const QUIET: AlarmsVerdict = { known: true, alarms: alarms() };
const OUTSIDE = figure(null, { status: "outside" });

interface Drill {
  depth_mm?: number;
  remaining_mm?: number;
  entry?: FigureMessage;
  angle?: FigureMessage;
  wall?: FigureMessage;
  /** Right of the channel on the bull's-eye. */
  right_mm?: number;
  medial_deg?: number;
  medial_is_right?: boolean;
}

function at(drill: Drill): NumbersVerdict {
  const image = snapshot();
  const [tool] = image.tools;
  if (tool?.deviation.kind !== "deviation" || tool.along === null)
    throw new Error("the builder's tool has both");
  const { depth_mm = -20, remaining_mm = 60, medial_deg: transverse_deg = 0, right_mm = 0 } = drill;
  const deviation = { ...tool.deviation, depth_mm, remaining_mm, transverse_deg };
  const { medial_is_right = true } = drill;
  const along = { ...tool.along, at_entry_mm: [right_mm, 0], medial_is_right };
  const figures = { entry: figure(1), angle: figure(2), wall: OUTSIDE, ...drillFigures(drill) };
  const tools = [{ ...tool, deviation, along, assessment: assessment({}, figures) }];
  const reading = readingOf({ ...image, tools }, headline());
  if (!reading.known) throw new Error("the builder's figures are known");
  return { live: true, reading, imageNumber: 1, ageMs: 0, snapshot: image };
}

function drillFigures({ entry, angle, wall }: Drill): Record<string, FigureMessage> {
  const given = Object.entries({ entry, angle, wall });
  return Object.fromEntries(given.filter((one): one is [string, FigureMessage] => one[1] !== undefined));
}

function over(value: number): FigureMessage {
  return figure(value, { status: "over" });
}

test("within both limits the two notes are the home notes, from the middle", () => {
  const tone = toneOf(at({ right_mm: 1.2, medial_deg: 3 }), QUIET);
  expect(tone).toEqual({
    kind: "align",
    offset: { hz: HOME_HZ.offset, pan: 0 },
    angle: { hz: HOME_HZ.angle, pan: 0 },
  });
});

test("a larger offset is higher, and is heard from the side of the channel", () => {
  const right = toneOf(at({ entry: over(10), right_mm: 10 }), QUIET);
  expect(right).toMatchObject({ offset: { hz: 2 * HOME_HZ.offset, pan: -1 }, angle: { hz: HOME_HZ.angle } });
  const left = toneOf(at({ entry: over(4), right_mm: -2.5 }), QUIET);
  expect(left).toMatchObject({ offset: { pan: 0.5 } });
  // Two octaves at most, so that far away it is not shrill.
  expect(toneOf(at({ entry: over(300), right_mm: 300 }), QUIET)).toMatchObject({
    offset: { hz: 4 * HOME_HZ.offset },
  });
});

test("the side of the angle follows the bull's-eye, on which medial is right or left", () => {
  const drill = { angle: over(10), medial_deg: 5 };
  expect(toneOf(at(drill), QUIET)).toMatchObject({ angle: { hz: 2 * HOME_HZ.angle, pan: -1 } });
  expect(toneOf(at({ ...drill, medial_is_right: false }), QUIET)).toMatchObject({ angle: { pan: 1 } });
});

test("in the bone it ticks, faster with less depth to go, and not beyond the planned end", () => {
  const ticks = (remaining_mm: number) => {
    const tone = toneOf(at({ depth_mm: 5, remaining_mm, wall: figure(2) }), QUIET);
    return tone?.kind === "drill" ? tone.ticksPerS : null;
  };
  expect([ticks(40), ticks(20), ticks(10), ticks(0.1), ticks(0), ticks(-1)]).toEqual([
    2,
    2,
    5,
    expect.closeTo(7.97),
    null,
    null,
  ]);
});

const BREACH = alarm({ priority: "high" });
test.each<[string, NumbersVerdict, AlarmsVerdict]>([
  ["an alarm sounds", at({}), { known: true, alarms: alarms({ sound: "medium" }) }],
  [
    "an alarm is listed, and its sound is paused",
    at({}),
    { known: true, alarms: alarms({ alarms: [BREACH] }) },
  ],
  ["alarms are unknown", at({}), { known: false, everReceived: true }],
  ["figures are too old", { live: false, cause: "old", unread: null, ageMs: 900 }, QUIET],
  ["the drill is not seen", { live: false, cause: "unread", unread: null, ageMs: 10 }, QUIET],
  ["the entry is withheld", at({ entry: figure(null) }), QUIET],
  ["the wall is withheld in the bone", at({ depth_mm: 5, wall: figure(null) }), QUIET],
])("it is silent while %s", (_what, numbers, verdict) => {
  expect(toneOf(numbers, verdict)).toBeNull();
});
