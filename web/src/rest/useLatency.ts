// The latency from light to page, as it was measured last with the camera of now.
import type { components } from "../schema";
import { answered, server } from "./client";
import { useQuery, type QueryState } from "./useQuery";

export type Latency = components["schemas"]["LatencyMessage"];

/** On a screen that is only looked at: it is measured before the theatre, by somebody else. */
const ASK_EVERY_MS = 60_000;

export function useLatency(): QueryState<Latency> {
  return useQuery((signal) => answered(server.GET("/api/latency", { signal })), { everyMs: ASK_EVERY_MS });
}
