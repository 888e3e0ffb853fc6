// Texts of an alarm for the displayed figures. Pure.
import { isOfNow } from "../live/assess";
import type { View } from "../live/live";
import type { AlarmMessage } from "../live/messages";

export type AlarmTexts = Pick<AlarmMessage, "sentence" | "remedy" | "known">;

/**
 * Returns the texts of an alarm with the image whose figures are displayed. If the figures were removed for their
 * age, or the image does not have the alarm (React lists alarms up to one refresh later), returns the texts that
 * claim nothing about the present.
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
