import { useRef, type ReactNode } from "react";
import { usePainter } from "../live/LiveContext";
import type { AlarmMessage, Priority } from "../live/messages";
import { setText } from "../panes/setText";
import type { Texts } from "../texts/en";
import { textOf } from "../texts/text";
import { useTexts } from "../texts/TextsContext";
import { textsBeside, type AlarmTexts } from "./alarmTexts";

export const MARKS: Record<Priority, string> = { high: "▲▲▲", medium: "▲▲", low: "▲" };

/** Text of an alarm, painted with the figures of the same image, so that their numbers agree. */
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
      <span data-part="sentence" ref={sentence} /> <strong data-part="remedy" ref={remedy} />{" "}
      <span data-part="known" ref={known} />
    </>
  );
}

/** An alarm below the highest: title and sentence. */
export function AlarmLine({ alarm }: { alarm: AlarmMessage }): ReactNode {
  const texts = useTexts();
  const line = useRef<HTMLSpanElement>(null);
  usePainter((view) => {
    setText(line.current, lineText(textsBeside(view, alarm), texts));
  });
  return (
    <>
      <span aria-hidden="true">{alarm.state === "latched" ? "" : MARKS[alarm.priority]}</span>{" "}
      <span className="heard-only">{texts.alarms.priority[alarm.priority]}</span>
      <b>{textOf(alarm.title, texts)}</b> <span ref={line} />
    </>
  );
}

function lineText({ sentence, known }: AlarmTexts, texts: Texts): string {
  return [textOf(sentence, texts), textOf(known, texts)].filter((part) => part !== "").join(" ");
}
