import { answered, server } from "../../rest/client";
import { useQuery, type QueryState } from "../../rest/useQuery";
import type { components } from "../../schema";

export type Gates = components["schemas"]["GatesMessage"];

/** The limits of each step. */
export function useGates(): QueryState<Gates> {
  return useQuery((signal) => answered(server.GET("/api/gates", { signal })));
}
