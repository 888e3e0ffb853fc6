import { useEffect, useRef, useState } from "react";
import { numberAt, type Curves, type Timeline } from "./timeline";

interface Playback {
  timeline: Timeline;
  whole: Curves;
  shown: { instant: { at_s: number } | null };
  isLoading: boolean;
  onNumber: (number: number) => void;
}

const FRAME_MS = 40;

/** Plays at the recorded rate. It waits for a late image and then skips the missed ones. */
export function usePlayback({
  timeline,
  whole,
  shown,
  isLoading,
  onNumber,
}: Playback): [boolean, (on: boolean) => void] {
  const [isPlaying, setIsPlaying] = useState(false);
  const [, setTick] = useState(0);
  const begin = useRef<{ atMs: number; atS: number } | null>(null);
  const atS = shown.instant?.at_s ?? 0;
  useEffect(() => {
    if (!isPlaying) {
      begin.current = null;
      return;
    }
    if (isLoading) return;
    begin.current ??= { atMs: performance.now(), atS };
    const timer = setTimeout(() => {
      if (begin.current === null) return;
      const toS = begin.current.atS + (performance.now() - begin.current.atMs) / 1000;
      onNumber(numberAt(whole, toS, timeline.images));
      if (toS >= timeline.duration_s) setIsPlaying(false);
      else setTick((before) => before + 1);
    }, FRAME_MS);
    return () => {
      clearTimeout(timer);
    };
  });
  return [isPlaying, setIsPlaying];
}
