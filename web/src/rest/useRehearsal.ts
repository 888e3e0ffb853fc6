// State of the rehearsal; requested only if the source is the simulated theatre.
import { useLive } from "../live/LiveContext";
import { getRehearsal, type RehearsalMessage } from "../api";
import { useQuery, type QueryState } from "./useQuery";

export type Rehearsed = RehearsalMessage;

interface Wish {
  everyMs?: number;
  /** Also requests the ground truth, to guide through a rehearsal. */
  truth?: boolean;
}

/** No data with a real camera: there is nothing to request. */
export function useRehearsal({ everyMs = 0, truth = false }: Wish = {}): QueryState<Rehearsed | null> {
  const isRehearsal = useLive().view.newest?.source.name === "rehearsal";
  return useQuery<Rehearsed | null>(
    async (signal) => (isRehearsal ? getRehearsal({ signal, query: { truth } }) : null),
    { key: String(isRehearsal), everyMs },
  );
}
