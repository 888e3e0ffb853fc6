import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import type { AlarmMessage } from "../live/messages";
import { sentence } from "../operator/parts/format";
import { problemsOf } from "../panes/problems";
import { languageOf, textOf } from "../texts/text";
import { useTexts } from "../texts/TextsContext";
import { AlarmSentence, MARKS } from "./AlarmSentence";
import type { AlarmsVerdict } from "./verdict";

/** The highest alarm; without alarms the first problem; or why neither is known. */
export function TopAlarm({ verdict }: { verdict: AlarmsVerdict }): ReactNode {
  const { alarms, cause, rest } = useTexts();
  const { view } = useLive();
  if (verdict.known) {
    const top = verdict.alarms.alarms[0];
    return top === undefined ? <NoAlarm /> : <Top alarm={top} />;
  }
  if (verdict.everReceived) return <Unknown state={alarms.unknown} />;
  if (view.firstMessage === "awaited") return <p className="alarms-none">{rest.loading}</p>;
  const { state, sentence: reason } = cause["not-reached"];
  return <Unknown state={state} reason={reason} />;
}

function Top({ alarm }: { alarm: AlarmMessage }): ReactNode {
  const texts = useTexts();
  const isOver = alarm.state === "latched" && alarm.presence !== "yes";
  const priority = texts.alarms.priority[alarm.priority];
  return (
    <>
      <p className="heard-only" role="alert">
        {priority}: {textOf(alarm.title, texts)}
      </p>
      <div className="alarms-top" data-testid="alarm-top" data-condition={alarm.condition}>
        <p className="alarms-state">
          <span className="alarms-priority">
            {/* An alarm that is over has no urgency marks. */}
            <span aria-hidden="true">{isOver ? "" : MARKS[alarm.priority]}</span>{" "}
            <small>{isOver ? texts.alarms.over : priority}</small>
          </span>{" "}
          <span className="alarms-title">{textOf(alarm.title, texts)}</span>
        </p>
        <p className="alarms-sentence">
          <AlarmSentence alarm={alarm} />
        </p>
      </div>
    </>
  );
}

function NoAlarm(): ReactNode {
  const texts = useTexts();
  const problem = problemsOf(useLive().view)[0];
  if (problem === undefined) return <p className="alarms-none">{texts.alarms.none}</p>;
  return (
    <div className="alarms-top">
      <p className="alarms-sentence" lang={languageOf(problem, texts)}>
        <strong>{textOf(problem.remedy, texts)}</strong> {sentence(textOf(problem.message, texts))}
      </p>
    </div>
  );
}

function Unknown({ state, reason = "" }: { state: string; reason?: string }): ReactNode {
  return (
    <div className="alarms-top alarms-unknown">
      <p className="alarms-state" role="alert">
        <span aria-hidden="true">▲▲</span> {state}
      </p>
      {reason !== "" && <p className="alarms-sentence">{reason}</p>}
    </div>
  );
}
