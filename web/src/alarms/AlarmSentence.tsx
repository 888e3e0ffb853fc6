import type { ReactNode } from "react";
import type { AlarmMessage, Priority } from "../live/messages";
import { useWords } from "../words/WordsContext";
import { measureText } from "./measureText";

export const MARKS: Record<Priority, string> = { high: "▲▲▲", medium: "▲▲", low: "▲" };

/** What an alarm says, with its number and limit, and whether it is over or acknowledged. */
export function AlarmSentence({ alarm }: { alarm: AlarmMessage }): ReactNode {
  const words = useWords().alarms;
  return (
    <>
      {alarm.by && `${alarm.by}: `}
      {words.conditions[alarm.condition].sentence}
      <AlarmNumber alarm={alarm} />.
    </>
  );
}

/** One of the alarms that are not the highest: short, because the highest is what matters. */
export function AlarmLine({ alarm }: { alarm: AlarmMessage }): ReactNode {
  const words = useWords().alarms;
  return (
    <>
      <span aria-hidden="true">{MARKS[alarm.priority]}</span>{" "}
      <span className="heard-only">{words.priority[alarm.priority]}</span>
      <b>{words.conditions[alarm.condition].state}</b>
      {alarm.by && ` ${alarm.by}`}
      <AlarmNumber alarm={alarm} />
    </>
  );
}

function AlarmNumber({ alarm }: { alarm: AlarmMessage }): ReactNode {
  const words = useWords().alarms;
  const over = alarm.state === "latched";
  const number = measureText(over ? alarm.worst : alarm.measure, words.limit);
  return (
    <>
      {number && `: ${number}`}
      {over && ` · ${words.over}`}
      {alarm.acknowledged_by && ` · ${words.acknowledgedBy} ${alarm.acknowledged_by}`}
    </>
  );
}
