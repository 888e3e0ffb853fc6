// How the open case stands, asked slowly: what moves quickly comes with each image.
import { answered, server } from "../rest/client";
import { useAsked } from "../rest/useAsked";
import type { components } from "../schema";

export type Standing = components["schemas"]["ProcedureMessage"];

const ASK_EVERY_MS = 4000;

export function useStanding(): Standing | null {
  return useAsked((signal) => answered(server.GET("/api/procedure", { signal })), { everyMs: ASK_EVERY_MS })
    .data;
}
