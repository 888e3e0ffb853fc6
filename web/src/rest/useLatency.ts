// The last measured latency from light to page of the current camera.
import type { components } from "../schema";
import { answered, server } from "./client";
import { useQuery, type QueryState } from "./useQuery";

export type Latency = components["schemas"]["LatencyMessage"];

/** On a screen that only displays: the latency is measured elsewhere, before the operation. */
const ASK_EVERY_MS = 60_000;

export function useLatency(): QueryState<Latency> {
  return useQuery((signal) => answered(server.GET("/api/latency", { signal })), { everyMs: ASK_EVERY_MS });
}
