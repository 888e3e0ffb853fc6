import { expect, test } from "vitest";
import { viewAt } from "../app/views";
import { de } from "../texts/de";
import { en } from "../texts/en";
import { mayTour, STATIONS } from "./stations";

test.each([
  ["rehearsal", "operator", true],
  ["rehearsal", "supervisor", false],
  ["rehearsal", "screen", false],
  ["/dev/video0", "operator", false],
  ["recording.mcap", "operator", false],
  [null, "operator", false],
] as const)("from %s as %s the tour may run: %s", (source, role, may) => {
  expect(mayTour(source, role)).toBe(may);
});

test("each station is shown once, on a page that an operator may open", () => {
  expect(new Set(STATIONS.map((one) => one.name)).size).toBe(STATIONS.length);
  for (const { path } of STATIONS) expect(path).toMatch(new RegExp(`^/${viewAt(path, "operator")}(/|$)`));
});

test.each([
  ["English", en],
  ["German", de],
])("the tour in %s takes about three minutes to read, at 180 words a minute", (_, { tour }) => {
  const words = STATIONS.map(({ name }) => tour.stations[name].sentence.split(" ").length);
  expect(words.reduce((sum, one) => sum + one)).toBeLessThan(3 * 180);
});
