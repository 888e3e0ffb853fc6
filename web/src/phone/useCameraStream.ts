// State of the stream for the page. Started and stopped by touch, and stopped on unmount.
import { useCallback, useEffect, useRef, useState, type RefObject } from "react";
import type { CameraFacts, FrameTime, Note, Problem, Welcome } from "./messages";
import { noCameraOf, type NoCamera } from "./noCamera";
import { Rate } from "./rate";
import { startCameraStream } from "./cameraStream";

type CameraStreamState = "idle" | "connecting" | "opening" | "sending" | "lost" | "none";

export interface CameraStream {
  state: CameraStreamState;
  welcome: Welcome | null;
  facts: CameraFacts | null;
  last: { bytes: number; clock: FrameTime["clock"]; rateHz: number } | null;
  note: Note | null;
  hasWakeLock: boolean;
  rejected: Problem | null;
  noCamera: NoCamera | null;
}

const IDLE: CameraStream = {
  state: "idle",
  welcome: null,
  facts: null,
  last: null,
  note: null,
  hasWakeLock: true,
  rejected: null,
  noCamera: null,
};

export function useCameraStream(video: RefObject<HTMLVideoElement | null>): {
  sending: CameraStream;
  start: () => void;
  stop: () => void;
} {
  const [sending, setSending] = useState<CameraStream>(IDLE);
  const running = useRef<(() => void) | null>(null);

  const stop = useCallback(() => {
    running.current?.();
    running.current = null;
    setSending(IDLE);
  }, []);
  const start = (): void => {
    if (video.current === null || running.current !== null) return;
    const change = (part: Partial<CameraStream>): void => {
      setSending((before) => ({ ...before, ...part }));
    };
    const over = (part: Partial<CameraStream>): void => {
      running.current = null;
      setSending({ ...IDLE, ...part });
    };
    const rate = new Rate();
    setSending({ ...IDLE, state: "connecting" });
    running.current = startCameraStream(video.current, {
      onWelcome: (welcome) => {
        change({ welcome, state: "opening" });
      },
      onFacts: (facts) => {
        change({ facts });
      },
      onSent: ({ bytes, clock }) => {
        rate.count(performance.now());
        change({ state: "sending", last: { bytes, clock, rateHz: rate.hz(performance.now()) } });
      },
      onNote: (note) => {
        // The rate of a previous stream does not apply.
        const isSilent = rate.hz(performance.now()) === 0;
        setSending((before) => ({
          ...before,
          note,
          ...(before.last !== null && isSilent ? { state: "none", last: null } : {}),
          ...(note === null ? { state: "lost", last: null } : {}),
        }));
      },
      onWakeLock: (hasWakeLock) => {
        change({ hasWakeLock });
      },
      onRejected: (rejected) => {
        over({ rejected });
      },
      onNoCamera: (error) => {
        over({ noCamera: noCameraOf(error) });
      },
    });
  };
  useEffect(() => stop, [stop]);
  return { sending, start, stop };
}
