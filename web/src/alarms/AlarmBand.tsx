import { useRef, useState, type ReactNode } from "react";
import { useLive, usePainter } from "../live/LiveContext";
import type { AlarmMessage, AlarmsMessage, Priority } from "../live/messages";
import { setData, setText } from "../panes/setText";
import { useWords } from "../words/WordsContext";
import { acknowledge, pause, resume } from "./desk";
import { isLit } from "./flash";
import { measureText } from "./measureText";
import { useAlarmSound, type AlarmSound } from "./useAlarmSound";
import { alarmsVerdict } from "./verdict";

export const MARKS: Record<Priority, string> = { high: "▲▲▲", medium: "▲▲", low: "▲" };
const PAUSE_S = 120;

/** The alarms: the highest in big words, the others listed, and what can be done about them. */
export function AlarmBand(): ReactNode {
  const words = useWords().alarms;
  const { view } = useLive();
  const sound = useAlarmSound();
  const band = useRef<HTMLElement>(null);
  const verdict = alarmsVerdict(view, view.link !== "connecting");
  usePainter((now) => {
    const is = alarmsVerdict(now, true);
    const top = is.known ? is.alarms.alarms[0] : undefined;
    const flashes = top?.state === "active";
    setData(band.current, "lit", String(!flashes || isLit(top.priority, now.nowMs)));
  });
  const top = verdict.known ? verdict.alarms.alarms[0] : undefined;
  return (
    <section
      className="alarms"
      aria-label={words.title}
      data-testid="alarms"
      data-priority={verdict.known ? (top?.priority ?? "none") : "unknown"}
      data-state={top?.state ?? "normal"}
      ref={band}
    >
      {verdict.known ? <Known alarms={verdict.alarms} /> : <Unknown sound={sound} />}
      <Arming sound={sound} />
    </section>
  );
}

function Known({ alarms }: { alarms: AlarmsMessage }): ReactNode {
  const words = useWords().alarms;
  const [top, ...others] = alarms.alarms;
  const [failed, setFailed] = useState(false);
  const tell = (worked: boolean): void => {
    setFailed(!worked);
  };
  if (!top) return <p className="alarms-none">{words.none}</p>;
  const numbers = alarms.alarms.filter((one) => one.state !== "acknowledged").map((one) => one.number);
  return (
    <>
      <p className="heard-only" role="alert">
        {words.priority[top.priority]}: {words.conditions[top.condition].state}
      </p>
      <Top alarm={top} />
      {others.length > 0 && (
        <ul className="alarms-others" data-testid="alarms-others">
          {others.map((alarm) => (
            <li key={alarm.number} data-priority={alarm.priority}>
              <Sentence alarm={alarm} />
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
            {words.acknowledge}
          </button>
        )}
        {alarms.pause_left_s > 0 ? (
          <button type="button" data-testid="resume" onClick={() => void resume().then(tell)}>
            {words.paused} <PauseLeft /> · {words.resume}
          </button>
        ) : (
          alarms.sound !== "silent" && (
            <button type="button" data-testid="pause" onClick={() => void pause(PAUSE_S).then(tell)}>
              {words.pause}
            </button>
          )
        )}
        {failed && <strong role="status">{words.failed}</strong>}
      </div>
    </>
  );
}

function Top({ alarm }: { alarm: AlarmMessage }): ReactNode {
  const words = useWords().alarms;
  return (
    <div className="alarms-top" data-testid="alarm-top" data-condition={alarm.condition}>
      <p className="alarms-state">
        <span aria-hidden="true">{MARKS[alarm.priority]}</span>{" "}
        <small>{words.priority[alarm.priority]}</small> {words.conditions[alarm.condition].state}
      </p>
      <p className="alarms-sentence">
        <Sentence alarm={alarm} bare /> <strong>{words.conditions[alarm.condition].remedy}</strong>
      </p>
    </div>
  );
}

function Sentence({ alarm, bare = false }: { alarm: AlarmMessage; bare?: boolean }): ReactNode {
  const words = useWords().alarms;
  const { state, sentence } = words.conditions[alarm.condition];
  const over = alarm.state === "latched";
  const number = measureText(over ? alarm.worst : alarm.measure, words.limit);
  return (
    <>
      {!bare && (
        <>
          <span aria-hidden="true">{MARKS[alarm.priority]}</span> <b>{state}</b>{" "}
        </>
      )}
      {alarm.by && `${alarm.by}: `}
      {sentence}
      {number && `: ${number}`}
      {over && ` · ${words.over}`}
      {alarm.acknowledged_by && ` · ${words.acknowledgedBy} ${alarm.acknowledged_by}`}.
    </>
  );
}

function PauseLeft(): ReactNode {
  const left = useRef<HTMLSpanElement>(null);
  usePainter(({ newest }) => {
    setText(left.current, `${Math.ceil(newest?.alarms.pause_left_s ?? 0)} s`);
  });
  return <span data-testid="pause-left" ref={left} />;
}

function Unknown({ sound }: { sound: AlarmSound }): ReactNode {
  const words = useWords().alarms;
  const { nowMs } = useLive().view;
  const leftMs = sound.ownPauseUntilMs - nowMs;
  return (
    <>
      <p className="alarms-state" role="alert">
        <span aria-hidden="true">▲▲</span> {words.unknown}
      </p>
      <div className="alarms-buttons">
        {sound.armed && (
          <button
            type="button"
            onClick={() => {
              sound.pauseOwn(nowMs);
            }}
          >
            {leftMs > 0 ? `${words.paused} ${Math.ceil(leftMs / 1000)} s` : words.pause}
          </button>
        )}
      </div>
    </>
  );
}

function Arming({ sound }: { sound: AlarmSound }): ReactNode {
  const words = useWords().alarms;
  if (sound.armed) {
    return (
      <p className="alarms-armed" data-testid="sound" data-armed="true">
        {words.armed}
      </p>
    );
  }
  return (
    <button type="button" className="alarms-arm" data-testid="sound" data-armed="false" onClick={sound.arm}>
      {sound.failed ? words.armFailed : words.arm}
    </button>
  );
}
