import { answered, server } from "../../rest/client";
import { useAsked, type Asked } from "../../rest/useAsked";
import type { components } from "../../schema";

const ASK_EVERY_MS = 1500;

/** What somebody has begun, here or on another tablet, and neither kept nor thrown away. */
export function useRunning(): Asked<components["schemas"]["RunningMessage"]> {
  return useAsked((signal) => answered(server.GET("/api/registration/running", { signal })), {
    everyMs: ASK_EVERY_MS,
  });
}
