import { useEffect, useState, useSyncExternalStore } from "react";
import { loadSlice, sliceRepository, type Slice } from "./loadSlice";
import { SliceLoader, type SliceState } from "./sliceLoader";

/** The slice at this address; until it is loaded, the previous one, which shows its own position. */
export function useSlice(
  address: string | null,
  ahead: readonly string[],
): SliceState<Slice> & { retry: () => void } {
  const [loader] = useState(() => new SliceLoader<Slice>(loadSlice, sliceRepository));
  const state = useSyncExternalStore(loader.subscribe, loader.snapshot);
  const next = ahead.join("\n");
  useEffect(() => {
    if (address !== null) loader.request(address, next === "" ? [] : next.split("\n"));
  }, [loader, address, next]);
  return {
    ...state,
    retry: () => {
      loader.retry();
    },
  };
}
