// Texts of recorded events. Pure.
import type { Texts } from "../../texts/catalogue";
import { textOf } from "../../texts/text";
import { clockDuration } from "../recordingText";
import type { RecordedEvent } from "./timeline";

export const SYMBOL: Record<RecordedEvent["kind"], string> = {
  navigation: "▶",
  withheld: "◌",
  alarm: "▲",
  acknowledgement: "✓",
  mark: "✎",
  step: "◆",
  comment: "❝",
  note: "■",
};

/** "▲ BREACH · 0:04", "✓ BREACH · Anna". */
export function eventText(event: RecordedEvent, texts: Texts): string {
  const { kinds, notes } = texts.recording.review;
  const documents: Partial<Record<string, string>> = texts.case.kinds;
  const { kind, title, code, by, from_s, to_s } = event;
  const what =
    kind === "note"
      ? (notes[code] ?? code)
      : kind === "step"
        ? (documents[code] ?? code)
        : title === null
          ? ""
          : textOf(title, texts);
  const lasted = to_s === null ? "" : clockDuration(to_s - from_s);
  return [kinds[kind], what, by, lasted].filter((one) => one !== "").join(" · ");
}
