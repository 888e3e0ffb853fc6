import { useRef, type ReactNode } from "react";
import { useLive, usePainter } from "../live/LiveContext";
import { setData } from "../panes/setText";
import { useTexts } from "../texts/TextsContext";
import { isLit } from "./flash";
import { KnownAlarms } from "./KnownAlarms";
import { SoundState } from "./SoundState";
import { UnheardAlarms } from "./UnheardAlarms";
import { UnknownAlarms } from "./UnknownAlarms";
import { useAlarmSound } from "./useAlarmSound";
import { alarmsVerdict } from "./verdict";

/** Band of alarms: the highest in large type, the others listed, with their actions and the sound. */
export function AlarmBand(): ReactNode {
  const texts = useTexts().alarms;
  const { view } = useLive();
  const sound = useAlarmSound();
  const band = useRef<HTMLElement>(null);
  const verdict = alarmsVerdict(view, view.firstMessage === "received");
  const isLoading = view.firstMessage === "awaited";
  usePainter((now) => {
    const is = alarmsVerdict(now, true);
    const top = is.known ? is.alarms.alarms[0] : undefined;
    const flashes = top?.state === "active";
    setData(band.current, "lit", String(!flashes || isLit(top.priority, now.nowMs)));
  });
  const top = verdict.known ? verdict.alarms.alarms[0] : undefined;
  const isPaused = verdict.known ? verdict.alarms.pause_left_s > 0 : sound.ownPauseUntilMs > view.nowMs;
  return (
    <section
      className="alarms"
      aria-label={texts.title}
      data-testid="alarms"
      data-priority={verdict.known ? (top?.priority ?? "none") : isLoading ? "loading" : "unknown"}
      data-state={top?.state ?? "normal"}
      ref={band}
    >
      {verdict.known && <KnownAlarms alarms={verdict.alarms} />}
      {!verdict.known && (verdict.everReceived ? <UnknownAlarms sound={sound} /> : <UnheardAlarms />)}
      <SoundState sound={sound} isPaused={isPaused} />
    </section>
  );
}
