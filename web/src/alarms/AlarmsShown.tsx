import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { useWords } from "../words/WordsContext";
import { MARKS } from "./AlarmSentence";
import { measureText } from "./measureText";
import { alarmsVerdict } from "./verdict";

/** The alarms as theatre has them. They are acknowledged there, by people who stand before them. */
export function AlarmsShown(): ReactNode {
  const words = useWords().alarms;
  const { view } = useLive();
  const verdict = alarmsVerdict(view, view.link !== "connecting");
  const alarms = verdict.known ? verdict.alarms.alarms : [];
  return (
    <section
      className="alarms alarms-shown"
      aria-label={words.title}
      data-testid="alarms-shown"
      data-priority={verdict.known ? (alarms[0]?.priority ?? "none") : "unknown"}
    >
      {!verdict.known && (
        <p className="alarms-state" role="alert">
          <span aria-hidden="true">▲▲</span> {words.unknown}
        </p>
      )}
      {verdict.known && alarms.length === 0 && <p className="alarms-none">{words.none}</p>}
      {alarms.length > 0 && (
        <ul className="alarms-shown-list">
          {alarms.map((alarm) => {
            const saying = words.conditions[alarm.condition];
            const over = alarm.state === "latched";
            const number = measureText(over ? alarm.worst : alarm.measure, words.limit);
            return (
              <li key={alarm.number} data-priority={alarm.priority} data-condition={alarm.condition}>
                <span aria-hidden="true">{MARKS[alarm.priority]}</span>{" "}
                <small>{words.priority[alarm.priority]}</small> <b>{saying.state}</b>{" "}
                {alarm.by && `${alarm.by}: `}
                {saying.sentence}
                {number && `: ${number}`}
                {over && ` · ${words.over}`}
                {alarm.acknowledged_by && ` · ${words.acknowledgedBy} ${alarm.acknowledged_by}`}
              </li>
            );
          })}
        </ul>
      )}
    </section>
  );
}
