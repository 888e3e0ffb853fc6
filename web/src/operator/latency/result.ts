// A latency measurement, as sent by the server.
import type { LatencyResultMessage } from "../../api";

export type Result = LatencyResultMessage;

/** The stages of the latency. */
export const STAGES = ["screen and camera", "tracking", "server", "line", "page"] as const;
