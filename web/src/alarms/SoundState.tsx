import type { ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";
import type { AlarmSound } from "./useAlarmSound";

/** Whether this screen would sound an alarm. Always visible; a silent screen asks to be touched. */
export function SoundState({ sound, isPaused }: { sound: AlarmSound; isPaused: boolean }): ReactNode {
  const texts = useTexts().alarms;
  if (!sound.armed) {
    return (
      <button type="button" className="alarms-arm" data-testid="sound" data-armed="false" onClick={sound.arm}>
        {sound.failed ? texts.armFailed : texts.arm}
      </button>
    );
  }
  return (
    <p className="alarms-armed" data-testid="sound" data-armed="true" data-paused={isPaused}>
      <span aria-hidden="true">{isPaused ? "◌" : "●"}</span> {isPaused ? texts.paused : texts.armed}
    </p>
  );
}
