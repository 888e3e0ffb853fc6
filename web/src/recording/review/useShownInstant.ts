// An image of a recording with its results. They change together, so an image never appears with other figures.
import { useEffect, useState } from "react";
import { Rejection } from "../../rest/client";
import { getRecordingsByNameInstantsByNumber, type RecordedInstantMessage } from "../../api";

export type RecordedInstant = RecordedInstantMessage;

export interface ShownInstant {
  instant: RecordedInstant | null;
  /** The bitmap; null if it cannot be decoded. */
  source: string | null;
  rejection: Rejection | null;
}

/** The previous image stays until the requested one has arrived; obsolete requests are dropped. */
export function useShownInstant(name: string, number: number): { shown: ShownInstant; isLoading: boolean } {
  const [shown, setShown] = useState<ShownInstant & { number: number }>({
    instant: null,
    source: null,
    rejection: null,
    number: -1,
  });
  useEffect(() => {
    const stop = new AbortController();
    const load = async (): Promise<void> => {
      const path = { name, number };
      const source = `/api/recordings/${name}/images/${number}.jpg`;
      const image = new Image();
      image.src = source;
      const decoding = image.decode().then(
        () => source,
        () => null,
      );
      try {
        const instant = await getRecordingsByNameInstantsByNumber({ path, signal: stop.signal });
        const decoded = await decoding;
        if (!stop.signal.aborted) setShown({ instant, source: decoded, rejection: null, number });
      } catch (error) {
        if (stop.signal.aborted) return;
        if (!(error instanceof Rejection)) throw error;
        setShown({ instant: null, source: await decoding, rejection: error, number });
      }
    };
    void load();
    return () => {
      stop.abort();
    };
  }, [name, number]);
  return { shown, isLoading: shown.number !== number };
}
