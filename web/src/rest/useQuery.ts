// A server query for a component: fetched on mount, and again with `refetch()`.
import { useCallback, useEffect, useEffectEvent, useState } from "react";
import { Rejection } from "./client";

/** Without `data` and `rejection` nothing is known yet: show `QueryStatus.tsx`, never "none". */
export interface QueryState<Data> {
  data: Data | null;
  rejection: Rejection | null;
  isLoading: boolean;
  refetch: () => void;
}

type Known<Data> = Omit<QueryState<Data>, "refetch">;
const NOTHING: Known<never> = { data: null, rejection: null, isLoading: true };

/** Calls `ask` when `key` changes, on `again()`, and every `everyMs` if given. */
export function useQuery<Data>(
  fetchData: (signal: AbortSignal) => Promise<Data>,
  { key = "", everyMs = 0 }: { key?: string; everyMs?: number } = {},
): QueryState<Data> {
  const [state, setState] = useState<Known<Data> & { key: string }>({ key, ...NOTHING });
  const [round, setRound] = useState(0);
  const onFetch = useEffectEvent(fetchData);

  useEffect(() => {
    const stop = new AbortController();
    const run = async (): Promise<void> => {
      try {
        const data = await onFetch(stop.signal);
        if (!stop.signal.aborted) setState({ key, data, rejection: null, isLoading: false });
      } catch (error) {
        if (stop.signal.aborted) return;
        // A rejection clears the data: old data must not look current.
        if (error instanceof Rejection) setState({ key, data: null, rejection: error, isLoading: false });
        else throw error;
      }
      if (everyMs > 0 && !stop.signal.aborted) timer = setTimeout(() => void run(), everyMs);
    };
    let timer: ReturnType<typeof setTimeout> | undefined;
    void run();
    return () => {
      stop.abort();
      clearTimeout(timer);
    };
  }, [key, round, everyMs]);

  const refetch = useCallback(() => {
    setRound((before) => before + 1);
  }, []);
  // An answer to the previous key is ignored.
  const { data, rejection, isLoading } = state.key === key ? state : NOTHING;
  return { data, rejection, isLoading, refetch };
}
