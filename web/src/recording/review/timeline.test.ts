import { expect, test } from "vitest";
import {
  isWithin,
  maxStepMs,
  mergedNotes,
  numberAt,
  rowsOf,
  samplesOf,
  type Curves,
  type RecordedEvent,
} from "./timeline";

const curve = (values: (number | null)[]): Curves["entry"] => ({
  values,
  limits: values.map(() => 2),
  statuses: values.map((value) => (value === null ? null : "within")),
});
const CURVES: Curves = {
  numbers: [0, 10, 20],
  at_s: [0, 1, 3],
  entry: curve([1, null, 1.5]),
  angle: curve([1, null, 1]),
  depth: curve([1, null, 1]),
  wall: curve([null, null, -0.8]),
  risk: curve([0, null, 100]),
};

test("a figure that was withheld has no value, and every other its limit and status", () => {
  const samples = samplesOf(CURVES);
  expect(samples.map(({ atMs }) => atMs)).toEqual([0, 1000, 3000]);
  expect(samples.map(({ figures }) => figures?.entry.value)).toEqual([1, null, 1.5]);
  expect(samples.map(({ figures }) => figures?.risk?.value)).toEqual([0, null, 100]);
  expect(samples[2]?.figures?.wall).toEqual({ value: -0.8, limit: 2, status: "within" });
});

test.each([
  [0, 0],
  [0.5, 5],
  [1, 10],
  [2, 15],
  [3, 20],
  [-1, 0],
  [99, 20],
])("at %d s it is image %d", (atS, number) => {
  expect(numberAt(CURVES, atS, 21)).toBe(number);
});

test("without images there is none but the first", () => {
  const none = { ...CURVES, numbers: [], at_s: [] };
  expect(numberAt(none, 3, 0)).toBe(0);
});

test("samples of an hour are further apart than those of a minute", () => {
  expect(maxStepMs({ fromS: 0, toS: 60 })).toBe(700);
  expect(maxStepMs({ fromS: 0, toS: 3600 })).toBe(9000);
});

test.each([
  [1, 2, true],
  [4, 9, true],
  [9, null, false],
  [5, null, true],
  [0, 1.9, false],
])("from %d to %j s lies between 2 and 8 s: %s", (from_s, to_s, is) => {
  const event = { from_s, to_s } as RecordedEvent;
  expect(isWithin(event, { fromS: 2, toS: 8 })).toBe(is);
});

test("simultaneous alarms are in separate rows", () => {
  const events = [
    [0, 5],
    [1, 3],
    [3, 4],
    [6, 7],
  ].map(([from_s, to_s]) => ({ from_s, to_s }) as RecordedEvent);
  const rows = rowsOf(events).map((row) => row.map(({ from_s }) => from_s));
  expect(rows).toEqual([
    [0, 6],
    [1, 3],
  ]);
  expect(rowsOf([])).toEqual([[]]);
});

test("equal notes close to one another are one, and other events between them stay", () => {
  const event = (kind: RecordedEvent["kind"], code: string, from_s: number): RecordedEvent => ({
    kind,
    code,
    from_s,
    to_s: null,
    title: null,
    priority: null,
    by: "",
  });
  const alarm = event("alarm", "BREACH", 12);
  const missing = [10, 11, 14, 30].map((atS) => event("note", "IMAGES_MISSING", atS));
  const [first, second, third, later] = missing as [
    RecordedEvent,
    RecordedEvent,
    RecordedEvent,
    RecordedEvent,
  ];
  expect(mergedNotes([first, second, alarm, third, later])).toEqual([{ ...first, to_s: 14 }, alarm, later]);
  expect(mergedNotes([alarm, { ...alarm, from_s: 13 }])).toHaveLength(2);
});
