import { answered, server } from "../../rest/client";
import { useAsked } from "../../rest/useAsked";
import type { components } from "../../schema";

export type Gates = components["schemas"]["GatesMessage"];

/** What each step is held against; null until the server has said it. */
export function useGates(): Gates | null {
  return useAsked((signal) => answered(server.GET("/api/gates", { signal }))).data;
}
