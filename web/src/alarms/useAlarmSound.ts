// Connects the player to the live state, and reports every few seconds whether an alarm would be heard.
import { useEffect, useEffectEvent, useRef, useState } from "react";
import { useLive, usePainter } from "../live/LiveContext";
import { reportArmed, reportClosed } from "./alarmRequests";
import { AlarmPlayer } from "./player";
import { alarmsVerdict, requestedSound } from "./verdict";

const OWN_PAUSE_MS = 120_000;

export interface AlarmSound {
  armed: boolean;
  failed: boolean;
  arm: () => void;
  /** End of the pause of the screen's own alarm, on the page's clock. */
  ownPauseUntilMs: number;
  pauseOwn: (nowMs: number) => void;
}

export function useAlarmSound(): AlarmSound {
  const { dashboard } = useLive();
  const [player] = useState(() => new AlarmPlayer());
  const [armed, setArmed] = useState(false);
  const [failed, setFailed] = useState(false);
  const [ownPauseUntilMs, setOwnPauseUntilMs] = useState(0);
  const lastReceivedAtMs = useRef<number | null>(null);

  usePainter((view) => {
    const verdict = alarmsVerdict(view, lastReceivedAtMs.current !== null);
    if (verdict.known) lastReceivedAtMs.current = view.nowMs;
    const goneMs = lastReceivedAtMs.current === null ? 0 : view.nowMs - lastReceivedAtMs.current;
    player.want(requestedSound(verdict, goneMs, ownPauseUntilMs - view.nowMs));
  });

  const say = useEffectEvent((signal: AbortSignal) => {
    // A browser may suspend the sound, for example when another program takes the device.
    setArmed(player.armed);
    void reportArmed(player.armed, signal);
  });
  const everyMs = (dashboard?.armed_every_s ?? 2) * 1000;
  useEffect(() => {
    const stop = new AbortController();
    const timer = setInterval(() => {
      say(stop.signal);
    }, everyMs);
    addEventListener("pagehide", reportClosed, { signal: stop.signal });
    return () => {
      stop.abort();
      clearInterval(timer);
    };
  }, [everyMs]);

  const arm = (): void => {
    player.arm(dashboard?.sounds ?? []).then(
      (works) => {
        setArmed(works);
        setFailed(!works);
        if (works) void reportArmed(true, new AbortController().signal);
      },
      () => {
        setFailed(true);
      },
    );
  };
  const pauseOwn = (nowMs: number): void => {
    setOwnPauseUntilMs(nowMs + OWN_PAUSE_MS);
  };
  return { armed, failed, arm, ownPauseUntilMs, pauseOwn };
}
