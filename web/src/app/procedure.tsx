// The state of the procedure, requested once for everything on the page, and often enough that no gate
// looks open that is shut.
import { createContext, use, useCallback, useEffect, useMemo, useState, type ReactNode } from "react";
import { answered, server } from "../rest/client";
import { useQuery, type QueryState } from "../rest/useQuery";
import type { components } from "../schema";
import type { ViewName } from "./views";

export type Procedure = components["schemas"]["ProcedureMessage"];
export type Step = components["schemas"]["StepMessage"];

const OFTEN_MS = 1000;
/** On a screen that is only looked at: what moves quickly comes with each image. */
const SELDOM_MS = 4000;

interface SharedQuery extends QueryState<Procedure> {
  /** Requests it often from now on, until the returned function is called. */
  hurry: () => () => void;
  /** The open case of the last answer; null where none was open, undefined before the first answer. */
  caseId: string | null | undefined;
}

const ProcedureContext = createContext<SharedQuery | null>(null);

export function ProcedureProvider({ view, children }: { view: ViewName; children: ReactNode }): ReactNode {
  const [hurried, setHurried] = useState(0);
  const query = useQuery((signal) => answered(server.GET("/api/procedure", { signal })), {
    everyMs: view === "theatre" && hurried === 0 ? SELDOM_MS : OFTEN_MS,
  });
  const hurry = useCallback(() => {
    setHurried((before) => before + 1);
    return () => {
      setHurried((before) => before - 1);
    };
  }, []);
  const { data, rejection, isLoading, refetch } = query;
  const [caseId, setCaseId] = useState<string | null>();
  if (data !== null && data.case_id !== caseId) setCaseId(data.case_id);
  const shared = useMemo(
    () => ({ data, rejection, isLoading, refetch, hurry, caseId }),
    [data, rejection, isLoading, refetch, hurry, caseId],
  );
  return <ProcedureContext value={shared}>{children}</ProcedureContext>;
}

function useShared(): SharedQuery {
  const value = use(ProcedureContext);
  if (value === null) throw new Error("useProcedure must be used inside ProcedureProvider");
  return value;
}

/** As the page asks for it anyway. */
export function useProcedure(): QueryState<Procedure> {
  return useShared();
}

/**
 * The open case of the last answer, also while the server does not answer: unsaved work on a page belongs to its case,
 * and must not go with one failed request. Null where no case is open, undefined before the first answer.
 */
export function useCaseId(): string | null | undefined {
  return useShared().caseId;
}

/** Requested often while this is mounted, and at once when it mounts. */
export function useFrequentProcedure(): QueryState<Procedure> {
  const shared = useShared();
  const { hurry, refetch } = shared;
  useEffect(() => {
    refetch();
    return hurry();
  }, [hurry, refetch]);
  return shared;
}
