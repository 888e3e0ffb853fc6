// The words of an alarm beside the figures that are displayed. Pure.
import { isOfNow } from "../live/assess";
import type { View } from "../live/live";
import type { AlarmMessage } from "../live/messages";

export type AlarmTexts = Pick<AlarmMessage, "sentence" | "remedy" | "known">;

/**
 * The texts of the alarm with the image whose figures are shown. Beside figures that were removed for their age, and
 * for an alarm that the shown image does not have (React lists the alarms up to one refresh of the screen later), these
 * are the texts that state nothing about now.
 */
export function textsBeside(
  { newest, numbers }: Pick<View, "newest" | "numbers">,
  alarm: AlarmMessage,
): AlarmTexts {
  const ofImage = newest?.alarms.alarms.find(({ number }) => number === alarm.number);
  if (ofImage !== undefined && isOfNow(numbers)) return ofImage;
  const now = ofImage ?? alarm;
  return { sentence: now.sentence_without_figures, remedy: now.remedy_without_figures, known: now.known };
}
