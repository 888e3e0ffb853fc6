import { useRef, useState, type ReactNode } from "react";
import { usePainter } from "../live/LiveContext";
import type { AlarmMessage, AlarmsMessage } from "../live/messages";
import { setText } from "../panes/setText";
import { textOf } from "../texts/text";
import { useTexts } from "../texts/TextsContext";
import { AlarmLine, AlarmSentence, MARKS } from "./AlarmSentence";
import { acknowledge, pause, resume } from "./alarmRequests";

const PAUSE_S = 120;

/** The current alarms with their actions. */
export function KnownAlarms({ alarms }: { alarms: AlarmsMessage }): ReactNode {
  const all = useTexts();
  const texts = all.alarms;
  const [top, ...others] = alarms.alarms;
  const [failed, setFailed] = useState(false);
  const tell = (worked: boolean): void => {
    setFailed(!worked);
  };
  if (!top) return <p className="alarms-none">{texts.none}</p>;
  const numbers = alarms.alarms.filter((one) => one.state !== "acknowledged").map((one) => one.number);
  return (
    <>
      <p className="heard-only" role="alert">
        {texts.priority[top.priority]}: {textOf(top.title, all)}
      </p>
      <Top alarm={top} />
      {others.length > 0 && (
        <ul className="alarms-others" data-testid="alarms-others">
          {others.map((alarm) => (
            <li key={alarm.number} data-priority={alarm.priority} data-state={alarm.state}>
              <AlarmLine alarm={alarm} />
            </li>
          ))}
        </ul>
      )}
      <div className="alarms-buttons">
        {numbers.length > 0 && (
          <button
            type="button"
            data-testid="acknowledge"
            onClick={() => void acknowledge(numbers).then(tell)}
          >
            {texts.acknowledge}
          </button>
        )}
        {alarms.pause_left_s > 0 ? (
          <button type="button" data-testid="resume" onClick={() => void resume().then(tell)}>
            {texts.paused} <PauseLeft /> · {texts.resume}
          </button>
        ) : (
          alarms.sound !== "silent" && (
            <button type="button" data-testid="pause" onClick={() => void pause(PAUSE_S).then(tell)}>
              {texts.pause}
            </button>
          )
        )}
        {failed && <strong role="status">{texts.failed}</strong>}
      </div>
    </>
  );
}

function Top({ alarm }: { alarm: AlarmMessage }): ReactNode {
  const texts = useTexts();
  const isOver = alarm.state === "latched" && alarm.presence !== "yes";
  return (
    <div className="alarms-top" data-testid="alarm-top" data-condition={alarm.condition}>
      <p className="alarms-state">
        {/* An alarm that is over has no urgency marks. */}
        <span aria-hidden="true">{isOver ? "" : MARKS[alarm.priority]}</span>{" "}
        <small>{isOver ? texts.alarms.over : texts.alarms.priority[alarm.priority]}</small>{" "}
        {textOf(alarm.title, texts)}
      </p>
      <p className="alarms-sentence">
        <AlarmSentence alarm={alarm} />
      </p>
    </div>
  );
}

function PauseLeft(): ReactNode {
  const left = useRef<HTMLSpanElement>(null);
  usePainter(({ newest }) => {
    setText(left.current, `${Math.ceil(newest?.alarms.pause_left_s ?? 0)} s`);
  });
  return <span data-testid="pause-left" ref={left} />;
}
