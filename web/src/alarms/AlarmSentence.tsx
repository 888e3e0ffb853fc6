import { useRef, type ReactNode } from "react";
import { usePainter } from "../live/LiveContext";
import type { AlarmMessage, Priority } from "../live/messages";
import { setText } from "../panes/setText";
import type { Words } from "../words/en";
import { textOf } from "../words/text";
import { useWords } from "../words/WordsContext";
import { wordsBeside, type AlarmWords } from "./alarmWords";

export const MARKS: Record<Priority, string> = { high: "▲▲▲", medium: "▲▲", low: "▲" };

/** What an alarm says: painted with the figures, from the same image, so that no two numbers differ. */
export function AlarmSentence({ alarm }: { alarm: AlarmMessage }): ReactNode {
  const words = useWords();
  const sentence = useRef<HTMLSpanElement>(null);
  const remedy = useRef<HTMLElement>(null);
  const known = useRef<HTMLSpanElement>(null);
  usePainter((view) => {
    const now = wordsBeside(view, alarm);
    setText(sentence.current, textOf(now.sentence, words));
    setText(remedy.current, textOf(now.remedy, words));
    setText(known.current, textOf(now.known, words));
  });
  return (
    <>
      <span data-part="sentence" ref={sentence} /> <strong data-part="remedy" ref={remedy} />{" "}
      <span data-part="known" ref={known} />
    </>
  );
}

/** One of the alarms that are not the first: its title and its sentence. */
export function AlarmLine({ alarm }: { alarm: AlarmMessage }): ReactNode {
  const words = useWords();
  const line = useRef<HTMLSpanElement>(null);
  usePainter((view) => {
    setText(line.current, lineText(wordsBeside(view, alarm), words));
  });
  return (
    <>
      <span aria-hidden="true">{alarm.state === "latched" ? "" : MARKS[alarm.priority]}</span>{" "}
      <span className="heard-only">{words.alarms.priority[alarm.priority]}</span>
      <b>{textOf(alarm.title, words)}</b> <span ref={line} />
    </>
  );
}

function lineText({ sentence, known }: AlarmWords, words: Words): string {
  return [textOf(sentence, words), textOf(known, words)].filter((part) => part !== "").join(" ");
}
