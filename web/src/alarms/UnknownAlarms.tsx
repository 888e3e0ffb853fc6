import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { useTexts } from "../texts/TextsContext";
import type { AlarmSound } from "./useAlarmSound";

/** Shown while the server does not answer: alarms are unknown; the screen's own alarm can be paused. */
export function UnknownAlarms({ sound }: { sound: AlarmSound }): ReactNode {
  const texts = useTexts().alarms;
  const { nowMs } = useLive().view;
  const leftMs = sound.ownPauseUntilMs - nowMs;
  return (
    <>
      <p className="alarms-state" role="alert">
        <span aria-hidden="true">▲▲</span> {texts.unknown}
      </p>
      <div className="alarms-buttons">
        {sound.armed && (
          <button
            type="button"
            onClick={() => {
              sound.pauseOwn(nowMs);
            }}
          >
            {leftMs > 0 ? `${texts.paused} ${Math.ceil(leftMs / 1000)} s` : texts.pause}
          </button>
        )}
      </div>
    </>
  );
}
