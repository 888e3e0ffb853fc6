import { answered, server } from "../../rest/client";
import { useQuery, type QueryState } from "../../rest/useQuery";
import type { components } from "../../schema";

const ASK_EVERY_MS = 1500;

/** Procedures begun here or on another tablet, and not concluded. */
export function useActiveProcedures(): QueryState<components["schemas"]["RunningMessage"]> {
  return useQuery((signal) => answered(server.GET("/api/registration/running", { signal })), {
    everyMs: ASK_EVERY_MS,
  });
}
