import { answered, server } from "../../rest/client";
import { useAsked, type Asked } from "../../rest/useAsked";
import type { components } from "../../schema";

export type Gates = components["schemas"]["GatesMessage"];

/** What each step is held against. */
export function useGates(): Asked<Gates> {
  return useAsked((signal) => answered(server.GET("/api/gates", { signal })));
}
