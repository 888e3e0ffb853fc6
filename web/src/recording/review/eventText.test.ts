import { expect, test } from "vitest";
import { de } from "../../texts/de";
import { en } from "../../texts/en";
import { eventText } from "./eventText";
import type { RecordedEvent } from "./timeline";

const EVENT: RecordedEvent = {
  kind: "alarm",
  from_s: 10,
  to_s: 14.2,
  code: "BREACH",
  title: { en: "BREACH", de: "DURCHBRUCH" },
  priority: "high",
  by: "",
};

test("an alarm shows its title and duration", () => {
  expect(eventText(EVENT, en)).toBe("Alarm · BREACH · 0:04");
  expect(eventText(EVENT, de)).toBe("Alarm · DURCHBRUCH · 0:04");
});

test("an acknowledgement shows its alarm and person", () => {
  const event = { ...EVENT, kind: "acknowledgement", to_s: null, by: "Anna" } as const;
  expect(eventText(event, en)).toBe("Acknowledged · BREACH · Anna");
});

test("a step is named by its document", () => {
  const step = { ...EVENT, kind: "step", to_s: null, title: null, by: "Anna" } as const;
  expect(eventText({ ...step, code: "registration" }, en)).toBe("Step · Registration · Anna");
  expect(eventText({ ...step, code: "newer" }, de)).toBe("Schritt · newer · Anna");
});

test("a note that this page does not know is named by its code", () => {
  const note = { ...EVENT, kind: "note", to_s: null, title: null } as const;
  expect(eventText({ ...note, code: "IMAGES_MISSING" }, en)).toBe("Recording · images are missing");
  expect(eventText({ ...note, code: "NEW" }, en)).toBe("Recording · NEW");
});
