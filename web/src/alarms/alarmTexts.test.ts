import { expect, test } from "vitest";
import { alarm, alarms } from "../live/alarmBuilders";
import { message } from "../live/builders";
import type { AlarmMessage, LiveMessage } from "../live/messages";
import type { NumbersVerdict } from "../live/assess";
import { textsBeside } from "./alarmTexts";

const now = alarm({ number: 4, sentence: text("Drill 0.4 mm through."), remedy: text("Withdraw.") });
const withImage = alarm({ number: 4, sentence: text("Drill 0.5 mm through.") });
const OLD: NumbersVerdict = { live: false, cause: "old", unread: null, ageMs: 400 };
const UNREAD: NumbersVerdict = { live: false, cause: "unread", unread: null, ageMs: 40 };

const newestWith = (...those: AlarmMessage[]): LiveMessage => message({ alarms: alarms({ alarms: those }) });

function text(en: string): { en: string; de: string } {
  return { en, de: en };
}

test("beside figures the alarm has the words of the same image", () => {
  expect(textsBeside({ newest: newestWith(withImage), numbers: UNREAD }, now).sentence).toEqual(
    withImage.sentence,
  );
});

test("an alarm that the shown image does not have states nothing about now", () => {
  const texts = textsBeside({ newest: newestWith(), numbers: UNREAD }, now);
  expect(texts.sentence).toEqual(now.sentence_without_figures);
  expect(texts.remedy).toEqual(now.remedy_without_figures);
});

test("without figures, no alarm states present values or gives instructions based on them", () => {
  const texts = textsBeside({ newest: newestWith(now), numbers: OLD }, now);
  expect(texts.sentence).toEqual(now.sentence_without_figures);
  expect(texts.remedy).toEqual(now.remedy_without_figures);
});
