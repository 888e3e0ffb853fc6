import { expect, test } from "vitest";
import { de } from "../texts/de";
import { channelName } from "./channelName";

test.each([
  ["L3 left", "L3 links"],
  ["rehearsal's L3 right", "L3 rechts · Probebetrieb"],
  ["S1 alar", "S1 alar"],
])("the channel %s is shown in German as %s", (name, shown) => {
  expect(channelName(name, de)).toBe(shown);
});
