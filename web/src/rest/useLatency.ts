// The last measured latency from light to page of the current camera.
import { getLatency, type LatencyMessage } from "../api";
import { useQuery, type QueryState } from "./useQuery";

export type Latency = LatencyMessage;

/** On a screen that only displays: the latency is measured elsewhere, before the operation. */
const ASK_EVERY_MS = 60_000;

export function useLatency(): QueryState<Latency> {
  return useQuery((signal) => getLatency({ signal }), { everyMs: ASK_EVERY_MS });
}
