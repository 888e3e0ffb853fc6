// A measured latency, as the server sends it.
import type { components } from "../../schema";

export type Result = components["schemas"]["LatencyResultMessage"];

/** The way of the light, part by part. */
export const STAGES = ["screen and camera", "tracking", "server", "line", "page"] as const;
export type Stage = (typeof STAGES)[number];
