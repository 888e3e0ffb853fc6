// A latency measurement, as sent by the server.
import type { components } from "../../schema";

export type Result = components["schemas"]["LatencyResultMessage"];

/** The stages of the latency. */
export const STAGES = ["screen and camera", "tracking", "server", "line", "page"] as const;
