import { useEffect, useState, useSyncExternalStore } from "react";
import { loadSlice, shelf, type Slice } from "./loadSlice";
import { SliceLine, type SliceState } from "./sliceLine";

/** The slice at this address as soon as it is there; until then the one before, which says its own place. */
export function useSlice(
  address: string | null,
  ahead: readonly string[],
): SliceState<Slice> & { again: () => void } {
  const [line] = useState(() => new SliceLine<Slice>(loadSlice, shelf));
  const state = useSyncExternalStore(line.subscribe, line.snapshot);
  const next = ahead.join("\n");
  useEffect(() => {
    if (address !== null) line.ask(address, next === "" ? [] : next.split("\n"));
  }, [line, address, next]);
  return {
    ...state,
    again: () => {
      line.again();
    },
  };
}
