// State of the procedure, polled once for the whole page, often enough that a gate never looks open
// after it has closed.
import { createContext, use, useCallback, useEffect, useMemo, useState, type ReactNode } from "react";
import { useQuery, type QueryState } from "../rest/useQuery";
import { getProcedure, type ProcedureMessage, type StepMessage } from "../api";
import type { ViewName } from "./views";

export type Procedure = ProcedureMessage;
export type Step = StepMessage;

const OFTEN_MS = 1000;
/** For a screen that only displays: fast changes arrive with each image. */
const SELDOM_MS = 4000;

interface SharedQuery extends QueryState<Procedure> {
  /** Polls at the high rate until the returned function is called. */
  hurry: () => () => void;
  /** The open case of the last answer; null if none was open, undefined before the first answer. */
  caseId: string | null | undefined;
}

const ProcedureContext = createContext<SharedQuery | null>(null);

export function ProcedureProvider({ view, children }: { view: ViewName; children: ReactNode }): ReactNode {
  const [hurried, setHurried] = useState(0);
  const query = useQuery((signal) => getProcedure({ signal }), {
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

/** Polled at the rate of the view. */
export function useProcedure(): QueryState<Procedure> {
  return useShared();
}

/**
 * The open case of the last answer, kept while the server does not answer: unsaved work belongs to its case and
 * must survive a failed request. Null if no case is open, undefined before the first answer.
 */
export function useCaseId(): string | null | undefined {
  return useShared().caseId;
}

/** Polled at the high rate while mounted, and at once on mount. */
export function useFrequentProcedure(): QueryState<Procedure> {
  const shared = useShared();
  const { hurry, refetch } = shared;
  useEffect(() => {
    refetch();
    return hurry();
  }, [hurry, refetch]);
  return shared;
}
