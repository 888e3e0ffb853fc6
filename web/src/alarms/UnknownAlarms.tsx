import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { useWords } from "../words/WordsContext";
import type { AlarmSound } from "./useAlarmSound";

/** Nothing is claimed of alarms while the server is not heard; the screen's own alarm can be paused. */
export function UnknownAlarms({ sound }: { sound: AlarmSound }): ReactNode {
  const { alarms: words, cause } = useWords();
  const { nowMs, firstMessage } = useLive().view;
  const notReached = cause["not-reached"];
  const leftMs = sound.ownPauseUntilMs - nowMs;
  return (
    <>
      <p className="alarms-state" role="alert">
        <span aria-hidden="true">▲▲</span> {firstMessage === "overdue" ? notReached.state : words.unknown}
      </p>
      {firstMessage === "overdue" && <p className="alarms-sentence">{notReached.sentence}</p>}
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
