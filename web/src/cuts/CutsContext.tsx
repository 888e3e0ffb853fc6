// The cuts of the theatre's page: one volume, one worker, and the panes that show what it cuts.
import { createContext, use, useEffect, useMemo, useState, type ReactNode } from "react";
import { useLive, usePainter } from "../live/LiveContext";
import type { ChannelMessage } from "../live/messages";
import type { View } from "../live/view";
import { Rejection } from "../rest/client";
import type { GreyWindow } from "./cut";
import { Cutter, type CutReply, type CutSubject } from "./cutter";
import { displayedDrill } from "./drill";
import { isSamePlan, wantsPlan, type VolumeState } from "./cutVerdict";
import { planPose } from "./overlay";
import { loadVolume, type Volume } from "./volume";

interface CutsValue {
  cutter: Cutter;
  volume: VolumeState;
  /** Names of the windows, the usual one first. */
  windows: string[];
  window: string;
  setWindow: (name: string) => void;
  /** How far ahead of the tip the probe's eye looks. */
  aheadMm: number;
  setAheadMm: (aheadMm: number) => void;
}

const CutsContext = createContext<CutsValue | null>(null);

const USUAL_WINDOW = "bone";
const USUAL_GREY: GreyWindow = { window_hu: 1800, level_hu: 400 };
const ASK_AGAIN_MS = { scanning: 2000, rejected: 10_000, other: 2000 };

export function CutsProvider({ children }: { children: ReactNode }): ReactNode {
  const [hasWorker, setHasWorker] = useState(typeof Worker !== "undefined");
  const [cutter] = useState(() => new Cutter());
  const [window, setWindow] = useState(USUAL_WINDOW);
  const [aheadMm, setAheadMm] = useState(0);
  const { live, view } = useLive();
  const channel = view.newest?.snapshot?.channel ?? null;
  const { state, presets } = useVolume(channel, cutter, hasWorker);
  const grey = presets[window] ?? USUAL_GREY;

  useEffect(() => {
    if (!hasWorker) return;
    const started = new Worker(new URL("./cutWorker.ts", import.meta.url), { type: "module" });
    started.onmessage = ({ data }: MessageEvent<CutReply>) => {
      cutter.receive(data);
      live.update();
    };
    started.onerror = () => {
      setHasWorker(false);
    };
    cutter.connect((message, transfer) => {
      started.postMessage(message, transfer);
    });
    return () => {
      cutter.connect(null);
      started.terminate();
    };
  }, [hasWorker, cutter, live]);

  usePainter((now) => {
    cutter.update(now.nowMs, subjectOf(now), grey);
  });

  const value = useMemo(
    () => ({
      cutter,
      volume: state,
      windows: Object.keys(presets),
      window,
      setWindow,
      aheadMm,
      setAheadMm,
    }),
    [cutter, state, presets, window, aheadMm],
  );
  return <CutsContext value={value}>{children}</CutsContext>;
}

export function useCuts(): CutsValue {
  const value = use(CutsContext);
  if (value === null) throw new Error("useCuts stands outside CutsProvider");
  return value;
}

/** What to cut for this view: the drill whose figures stand there, else the plan, else nothing. */
function subjectOf({ numbers, newest, nowMs, untrackedMs }: View): CutSubject | null {
  const channel = newest?.snapshot?.channel ?? null;
  if (channel === null) return null;
  if (numbers.live) {
    const drill = displayedDrill(numbers);
    const capturedAtMs = nowMs - numbers.ageMs;
    return drill === null
      ? null
      : { kind: "live", imageNumber: numbers.imageNumber, capturedAtMs, pose: drill.pose, channel };
  }
  const pose = wantsPlan(numbers, untrackedMs) ? planPose(channel) : null;
  return pose === null ? null : { kind: "plan", imageNumber: 0, capturedAtMs: nowMs, pose, channel };
}

interface LoadedVolume {
  state: VolumeState;
  presets: Record<string, GreyWindow>;
}

/** The volume of this channel's CT, loaded when another channel or CT is navigated. */
function useVolume(channel: ChannelMessage | null, cutter: Cutter, isSupported: boolean): LoadedVolume {
  const [loaded, setLoaded] = useState<LoadedVolume>({ state: { state: "loading" }, presets: {} });
  // Each message has a channel of its own: the same as before is kept, so that nothing is asked again.
  const [wanted, setWanted] = useState(channel);
  if (channel !== wanted && !(channel !== null && wanted !== null && isSamePlan(channel, wanted))) {
    setWanted(channel);
  }
  const ctId = wanted?.ct_id ?? null;

  useEffect(() => {
    if (ctId === null || !isSupported) return;
    const stop = new AbortController();
    let timer: ReturnType<typeof setTimeout> | undefined;
    const again = (ms: number): void => {
      timer = setTimeout(() => void load(), ms);
    };
    const take = (volume: Volume): void => {
      cutter.setVolume(volume);
      setLoaded({ state: { state: "ready", ctId: volume.ctId }, presets: volume.presets });
    };
    const load = async (): Promise<void> => {
      try {
        const volume = await loadVolume(stop.signal);
        if (stop.signal.aborted) return;
        if (volume === null) {
          setLoaded(({ presets }) => ({ state: { state: "scanning" }, presets }));
          again(ASK_AGAIN_MS.scanning);
        } else if (volume.ctId !== ctId) {
          // The server has changed over and its tracking not yet, or the other way round.
          again(ASK_AGAIN_MS.other);
        } else take(volume);
      } catch (error) {
        if (stop.signal.aborted) return;
        if (!(error instanceof Rejection)) throw error;
        const { problem } = error;
        setLoaded(({ presets }) => ({ state: { state: "rejected", problem }, presets }));
        again(ASK_AGAIN_MS.rejected);
      }
    };
    void load();
    return () => {
      stop.abort();
      clearTimeout(timer);
    };
  }, [wanted, ctId, cutter, isSupported]);

  if (!isSupported) return { state: { state: "unsupported" }, presets: loaded.presets };
  if (wanted !== null && ctId === null) return { state: { state: "none" }, presets: loaded.presets };
  return loaded;
}
