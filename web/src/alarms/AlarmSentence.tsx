import { useRef, type ReactNode } from "react";
import { usePainter } from "../live/LiveContext";
import type { AlarmMessage, Priority } from "../live/messages";
import { setText } from "../panes/setText";
import { textOf } from "../texts/text";
import { useTexts } from "../texts/TextsContext";
import { textsBeside } from "./alarmTexts";

export const MARKS: Record<Priority, string> = { high: "▲▲▲", medium: "▲▲", low: "▲" };

/** Text of an alarm, what to do first, painted with the figures of the same image, so that their numbers agree. */
export function AlarmSentence({ alarm }: { alarm: AlarmMessage }): ReactNode {
  const texts = useTexts();
  const sentence = useRef<HTMLSpanElement>(null);
  const remedy = useRef<HTMLElement>(null);
  const known = useRef<HTMLSpanElement>(null);
  usePainter((view) => {
    const now = textsBeside(view, alarm);
    setText(sentence.current, textOf(now.sentence, texts));
    setText(remedy.current, textOf(now.remedy, texts));
    setText(known.current, textOf(now.known, texts));
  });
  return (
    <>
      <strong data-part="remedy" ref={remedy} /> <span data-part="sentence" ref={sentence} />{" "}
      <span data-part="known" ref={known} />
    </>
  );
}

/** An alarm in a list: title and text. */
export function AlarmLine({ alarm }: { alarm: AlarmMessage }): ReactNode {
  const texts = useTexts();
  return (
    <>
      <span aria-hidden="true">{alarm.state === "latched" ? "" : MARKS[alarm.priority]}</span>{" "}
      <span className="heard-only">{texts.alarms.priority[alarm.priority]}</span>
      <b>{textOf(alarm.title, texts)}</b> <AlarmSentence alarm={alarm} />
    </>
  );
}
