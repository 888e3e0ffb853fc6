// What is rehearsed; asked only where the camera is the theatre in software.
import { useLive } from "../live/LiveContext";
import type { components } from "../schema";
import { answered, server } from "./client";
import { useQuery, type QueryState } from "./useQuery";

export type Rehearsed = components["schemas"]["RehearsalMessage"];

interface Wish {
  everyMs?: number;
  /** With what is true, for helping through a rehearsal. */
  truth?: boolean;
}

/** Without data where a real camera looks: there is nothing to play, and nothing to ask for. */
export function useRehearsal({ everyMs = 0, truth = false }: Wish = {}): QueryState<Rehearsed | null> {
  const isRehearsal = useLive().view.newest?.source.name === "rehearsal";
  return useQuery<Rehearsed | null>(
    async (signal) =>
      isRehearsal ? answered(server.GET("/api/rehearsal", { signal, params: { query: { truth } } })) : null,
    { key: String(isRehearsal), everyMs },
  );
}
