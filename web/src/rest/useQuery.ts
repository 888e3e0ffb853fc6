// A server query whose result a component shows: fetched at once, and again with `refetch()`.
import { useCallback, useEffect, useEffectEvent, useState } from "react";
import { Rejection } from "./client";

/** With neither `data` nor `rejection` nothing is known yet: `QueryStatus.tsx` stands in its place, never "none". */
export interface QueryState<Data> {
  data: Data | null;
  rejection: Rejection | null;
  isLoading: boolean;
  refetch: () => void;
}

type Known<Data> = Omit<QueryState<Data>, "refetch">;
const NOTHING: Known<never> = { data: null, rejection: null, isLoading: true };

/** `ask` is called when `key` changes, with `again()`, and every `everyMs` where that is given. */
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
        // What was known stands no more beside a rejection: old must not look like now.
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
  // The answer to another question is none to this one.
  const { data, rejection, isLoading } = state.key === key ? state : NOTHING;
  return { data, rejection, isLoading, refetch };
}
