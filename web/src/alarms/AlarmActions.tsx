import { useRef, useState, type ReactNode } from "react";
import { useLive, usePainter } from "../live/LiveContext";
import type { AlarmsMessage } from "../live/messages";
import { setText } from "../panes/setText";
import { useTexts } from "../texts/TextsContext";
import { acknowledge, pause, resume } from "./alarmRequests";
import type { AlarmSound } from "./useAlarmSound";

const PAUSE_S = 120;

/** Acknowledges the alarms, and pauses the sound of all screens. */
export function AlarmActions({ alarms }: { alarms: AlarmsMessage }): ReactNode {
  const texts = useTexts().alarms;
  const [failed, setFailed] = useState(false);
  const tell = (worked: boolean): void => {
    setFailed(!worked);
  };
  if (alarms.alarms.length === 0) return null;
  const numbers = alarms.alarms.filter((one) => one.state !== "acknowledged").map((one) => one.number);
  return (
    <>
      {numbers.length > 0 && (
        <button
          type="button"
          className="alarms-acknowledge"
          data-testid="acknowledge"
          onClick={() => void acknowledge(numbers).then(tell)}
        >
          {texts.acknowledge}
        </button>
      )}
      {alarms.pause_left_s > 0 ? (
        <button
          type="button"
          className="alarms-pause"
          data-testid="resume"
          onClick={() => void resume().then(tell)}
        >
          {texts.paused} <PauseLeft /> · {texts.resume}
        </button>
      ) : (
        alarms.sound !== "silent" && (
          <button
            type="button"
            className="alarms-pause"
            data-testid="pause"
            onClick={() => void pause(PAUSE_S).then(tell)}
          >
            {texts.pause}
          </button>
        )
      )}
      {failed && (
        <strong className="alarms-failed" role="status">
          {texts.failed}
        </strong>
      )}
    </>
  );
}

/** Pauses the screen's own alarm, which sounds while the server does not answer. */
export function OwnPause({ sound }: { sound: AlarmSound }): ReactNode {
  const texts = useTexts().alarms;
  const { nowMs } = useLive().view;
  const leftMs = sound.ownPauseUntilMs - nowMs;
  return (
    <button
      type="button"
      className="alarms-pause"
      onClick={() => {
        sound.pauseOwn(nowMs);
      }}
    >
      {leftMs > 0 ? `${texts.paused} ${Math.ceil(leftMs / 1000)} s` : texts.pause}
    </button>
  );
}

function PauseLeft(): ReactNode {
  const left = useRef<HTMLSpanElement>(null);
  usePainter(({ newest }) => {
    setText(left.current, `${Math.ceil(newest?.alarms.pause_left_s ?? 0)} s`);
  });
  return <span data-testid="pause-left" ref={left} />;
}
