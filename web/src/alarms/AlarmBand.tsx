import { useRef, type ReactNode } from "react";
import { useLive, usePainter } from "../live/LiveContext";
import { setData } from "../panes/setText";
import { useTexts } from "../texts/TextsContext";
import { AlarmActions, OwnPause } from "./AlarmActions";
import { isLit } from "./flash";
import { MoreAlarms } from "./MoreAlarms";
import { SoundState } from "./SoundState";
import { TopAlarm } from "./TopAlarm";
import { useAlarmSound, type AlarmSound } from "./useAlarmSound";
import { alarmsVerdict } from "./verdict";

/** The alarms with their actions and the sound of this screen. */
export function AlarmBand(): ReactNode {
  return <Band testId="alarms" sound={useAlarmSound()} />;
}

/** The alarms without actions: they are acknowledged in theatre. */
export function AlarmsShown(): ReactNode {
  return <Band testId="alarms-shown" sound={null} />;
}

/**
 * The place of the alarms: the highest in full, the others by name and one touch away. Each part has its own place
 * in a band of constant height, so that alarms that come and go move nothing.
 */
function Band({ testId, sound }: { testId: string; sound: AlarmSound | null }): ReactNode {
  const texts = useTexts().alarms;
  const { view } = useLive();
  const band = useRef<HTMLElement>(null);
  const verdict = alarmsVerdict(view, view.firstMessage === "received");
  usePainter((now) => {
    const is = alarmsVerdict(now, true);
    const top = is.known ? is.alarms.alarms[0] : undefined;
    const flashes = top?.state === "active";
    setData(band.current, "lit", String(!flashes || isLit(top.priority, now.nowMs)));
  });
  const alarms = verdict.known ? verdict.alarms.alarms : [];
  const isLoading = view.firstMessage === "awaited";
  const isPaused = verdict.known
    ? verdict.alarms.pause_left_s > 0
    : sound !== null && sound.ownPauseUntilMs > view.nowMs;
  return (
    <section
      className={sound === null ? "alarms alarms-shown" : "alarms"}
      aria-label={texts.title}
      data-testid={testId}
      data-priority={
        verdict.known
          ? (alarms[0]?.priority ?? "none")
          : isLoading && !verdict.everReceived
            ? "loading"
            : "unknown"
      }
      data-state={alarms[0]?.state ?? "normal"}
      ref={band}
    >
      <TopAlarm verdict={verdict} />
      <MoreAlarms alarms={alarms} />
      {sound !== null && (
        <>
          {verdict.known && <AlarmActions alarms={verdict.alarms} />}
          {!verdict.known && verdict.everReceived && sound.armed && <OwnPause sound={sound} />}
          <SoundState sound={sound} isPaused={isPaused} />
        </>
      )}
    </section>
  );
}
