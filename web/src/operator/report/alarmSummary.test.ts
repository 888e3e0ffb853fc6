import { expect, test } from "vitest";
import { alarmsIn } from "./alarmSummary";

const line = (change: string, condition: string, at: string, by?: string): Record<string, unknown> => ({
  change,
  condition,
  at,
  ...(by === undefined ? {} : { by }),
});

test("each condition with how often it was raised, when, and who acknowledged it", () => {
  const lines = [
    line("raised", "DRILL_UNSEEN", "1"),
    line("raised", "BREACH", "2"),
    line("acknowledged", "BREACH", "3", "M. Ito"),
    line("acknowledged", "BREACH", "4", "M. Ito"),
    line("cleared", "BREACH", "5"),
    line("raised", "BREACH", "6"),
    { change: "sound_paused", at: "7", by: "M. Ito" },
  ];
  expect(alarmsIn(lines)).toEqual([
    {
      condition: "BREACH",
      raised: 2,
      firstAt: "2",
      lastAt: "6",
      acknowledgedBy: ["M. Ito"],
      line: line("raised", "BREACH", "6"),
    },
    {
      condition: "DRILL_UNSEEN",
      raised: 1,
      firstAt: "1",
      lastAt: "1",
      acknowledgedBy: [],
      line: line("raised", "DRILL_UNSEEN", "1"),
    },
  ]);
});

test("a log that is cut off before an alarm was raised counts none of it", () => {
  expect(alarmsIn([line("cleared", "BREACH", "1"), {}])).toEqual([]);
});

test("the worst of all occurrences is kept, including a present one", () => {
  const at = (change: string, worst: number): Record<string, unknown> => ({
    ...line(change, "BREACH", "1"),
    worst,
    limit: 0,
  });
  const [breach] = alarmsIn([
    at("raised", -0.3),
    at("latched", -0.3),
    at("raised", -4.6),
    at("raised", -0.2),
  ]);
  expect(breach?.line).toEqual(at("raised", -4.6));
});
