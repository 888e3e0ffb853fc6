import type { ReactNode } from "react";
import { useWords } from "../words/WordsContext";
import type { AlarmSound } from "./useAlarmSound";

/** Whether an alarm would be heard here: always in sight; a screen that is silent asks to be touched. */
export function SoundState({ sound, isPaused }: { sound: AlarmSound; isPaused: boolean }): ReactNode {
  const words = useWords().alarms;
  if (!sound.armed) {
    return (
      <button type="button" className="alarms-arm" data-testid="sound" data-armed="false" onClick={sound.arm}>
        {sound.failed ? words.armFailed : words.arm}
      </button>
    );
  }
  return (
    <p className="alarms-armed" data-testid="sound" data-armed="true" data-paused={isPaused}>
      <span aria-hidden="true">{isPaused ? "◌" : "●"}</span> {isPaused ? words.paused : words.armed}
    </p>
  );
}
