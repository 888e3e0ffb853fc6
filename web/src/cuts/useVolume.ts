// Loads the CT around the navigated vertebra, and retries while there is none.
import { useEffect, useState } from "react";
import type { ChannelMessage } from "../live/messages";
import type { GreyWindow } from "./cut";
import type { Cutter } from "./cutter";
import { isSamePlan, volumeAfter, type VolumeState } from "./cutVerdict";
import { loadVolume, type Volume } from "./volume";

const ASK_AGAIN_MS = { scanning: 2000, failed: 10_000, other: 2000 };

interface LoadedVolume {
  state: VolumeState;
  presets: Record<string, GreyWindow>;
}

/** The volume of this channel's CT, reloaded when channel or CT change; kept while the channel is unknown. */
export function useVolume(
  channel: ChannelMessage | null | undefined,
  cutter: Cutter,
  { isSupported, isRequested }: { isSupported: boolean; isRequested: boolean },
): LoadedVolume {
  const [loaded, setLoaded] = useState<LoadedVolume>({ state: { state: "loading" }, presets: {} });
  // Each message has a new channel object: an equal one is reused, so that nothing is fetched again.
  const [wanted, setWanted] = useState(channel ?? null);
  if (
    channel !== undefined &&
    channel !== wanted &&
    !(channel !== null && wanted !== null && isSamePlan(channel, wanted))
  ) {
    setWanted(channel);
  }
  const ctId = wanted?.ct_id ?? null;

  useEffect(() => {
    if (ctId === null || !isSupported || !isRequested) return;
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
          // Server and tracking process change over at different times.
          again(ASK_AGAIN_MS.other);
        } else take(volume);
      } catch (error) {
        if (stop.signal.aborted) return;
        setLoaded(({ presets }) => ({ state: volumeAfter(error), presets }));
        again(ASK_AGAIN_MS.failed);
      }
    };
    void load();
    return () => {
      stop.abort();
      clearTimeout(timer);
    };
  }, [wanted, ctId, cutter, isSupported, isRequested]);

  const { presets } = loaded;
  if (!isSupported) return { state: { state: "unsupported" }, presets };
  if (wanted !== null && ctId === null) return { state: { state: "none" }, presets };
  if (!isRequested) return { state: { state: "on_request" }, presets };
  return loaded;
}
