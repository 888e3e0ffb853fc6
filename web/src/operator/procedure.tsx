// How the procedure stands, asked of the server often enough that no gate looks open that is shut.
import { createContext, use, type ReactNode } from "react";
import { answered, server } from "../rest/client";
import { useAsked, type Asked } from "../rest/useAsked";
import type { components } from "../schema";

export type Procedure = components["schemas"]["ProcedureMessage"];
export type Step = components["schemas"]["StepMessage"];

const ASK_EVERY_MS = 1000;

const ProcedureContext = createContext<Asked<Procedure> | null>(null);

export function ProcedureProvider({ children }: { children: ReactNode }): ReactNode {
  const asked = useAsked((signal) => answered(server.GET("/api/procedure", { signal })), {
    everyMs: ASK_EVERY_MS,
  });
  return <ProcedureContext value={asked}>{children}</ProcedureContext>;
}

export function useProcedure(): Asked<Procedure> {
  const value = use(ProcedureContext);
  if (value === null) throw new Error("useProcedure stands outside ProcedureProvider");
  return value;
}
