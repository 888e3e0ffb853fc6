// The words of an alarm beside the figures that stand on the page. Pure.
import { isOfNow } from "../live/assess";
import type { View } from "../live/live";
import type { AlarmMessage } from "../live/messages";

export type AlarmWords = Pick<AlarmMessage, "sentence" | "remedy" | "known">;

/**
 * The alarm as it was with the image whose figures are shown; itself where it was not yet raised then. Beside
 * figures that went for their age nothing that they show is said of now.
 */
export function wordsBeside(
  { alarms, numbers }: Pick<View, "alarms" | "numbers">,
  alarm: AlarmMessage,
): AlarmWords {
  const now = alarms?.alarms.find(({ number }) => number === alarm.number) ?? alarm;
  if (isOfNow(numbers)) return now;
  return { sentence: now.sentence_without_figures, remedy: now.remedy_without_figures, known: now.known };
}
