// The cuts of a page: one volume, one worker, and the panes that show its cuts.
import { createContext, use, useEffect, useMemo, useState, type ReactNode } from "react";
import { useLive, usePainter } from "../live/LiveContext";
import type { View } from "../live/view";
import type { GreyWindow } from "./cut";
import { Cutter, type CutReply, type CutSubject } from "./cutter";
import { displayedDrill } from "./drill";
import { wantsPlan, type VolumeState } from "./cutVerdict";
import { planPose } from "./overlay";
import { useVolume } from "./useVolume";

interface CutsValue {
  cutter: Cutter;
  volume: VolumeState;
  /** Names of the windows, the default first. */
  windows: string[];
  window: string;
  setWindow: (name: string) => void;
  /** How far ahead of the tip the probe's eye is. */
  aheadMm: number;
  setAheadMm: (aheadMm: number) => void;
  /** Loads the CT if loading waits for a request. */
  requestCt: () => void;
}

const CutsContext = createContext<CutsValue | null>(null);

const USUAL_WINDOW = "bone";
const USUAL_GREY: GreyWindow = { window_hu: 1800, level_hu: 400 };

interface CutsProviderProps {
  /** Load the CT only on request: a possibly slow connection is kept free for the figures. */
  ctOnRequest?: boolean;
  children: ReactNode;
}

export function CutsProvider({ ctOnRequest = false, children }: CutsProviderProps): ReactNode {
  const [hasWorker, setHasWorker] = useState(typeof Worker !== "undefined");
  const [cutter] = useState(() => new Cutter());
  const [window, setWindow] = useState(USUAL_WINDOW);
  const [aheadMm, setAheadMm] = useState(0);
  const { live, view } = useLive();
  // Without a snapshot, as without a camera, the channel is unknown.
  const channel = view.newest?.snapshot?.channel;
  const [isRequested, setRequested] = useState(!ctOnRequest);
  const { state, presets } = useVolume(channel, cutter, { isSupported: hasWorker, isRequested });
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
    cutter.update(now.nowMs, subjectOf(now), grey, now.budget.cutIntervalMs);
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
      requestCt: () => {
        setRequested(true);
      },
    }),
    [cutter, state, presets, window, aheadMm],
  );
  return <CutsContext value={value}>{children}</CutsContext>;
}

export function useCuts(): CutsValue {
  const value = use(CutsContext);
  if (value === null) throw new Error("useCuts must be used inside CutsProvider");
  return value;
}

/** Subject of the cuts: the drill whose figures are displayed, else the plan, else nothing. */
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
