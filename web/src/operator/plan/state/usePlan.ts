// The newest plan, polled every few seconds, because two tablets may plan at once.
import { useCallback, useEffect, useRef, useState } from "react";
import { getPlan } from "../../../api";
import { Rejection } from "../../../rest/client";
import { hasDocument } from "./documents";
import type { PlanAnswer } from "./shape";

const ASK_EVERY_MS = 3000;

interface PlanQuery {
  plan: PlanAnswer | null;
  /** Why the plan cannot be shown; null if there is none yet. */
  rejection: Rejection | null;
  /** Whether the first answer is pending. */
  isLoading: boolean;
  /** Result of a change; older pending answers are ignored. */
  take: (plan: PlanAnswer) => void;
  refetch: () => Promise<PlanAnswer | null>;
}

interface Known {
  plan: PlanAnswer | null;
  rejection: Rejection | null;
  isLoading: boolean;
}

export function usePlan(caseId: string): PlanQuery {
  const [known, setKnown] = useState<Known>({ plan: null, rejection: null, isLoading: true });
  const changes = useRef(0);
  const isThere = useRef(false);

  const refetch = useCallback(async (): Promise<PlanAnswer | null> => {
    const before = changes.current;
    const next = await fetchPlan(caseId, isThere.current);
    isThere.current = next.plan !== null;
    if (before === changes.current) setKnown(next);
    return next.plan;
  }, [caseId]);
  const take = useCallback((plan: PlanAnswer) => {
    changes.current += 1;
    setKnown({ plan, rejection: null, isLoading: false });
  }, []);

  useEffect(() => {
    const timer = setInterval(() => void refetch(), ASK_EVERY_MS);
    const soon = setTimeout(() => void refetch());
    return () => {
      clearInterval(timer);
      clearTimeout(soon);
    };
  }, [refetch]);
  return { ...known, take, refetch };
}

async function fetchPlan(caseId: string, wasThere: boolean): Promise<Known> {
  try {
    if (!wasThere && !(await hasDocument(caseId, "plan")))
      return { plan: null, rejection: null, isLoading: false };
    return { plan: await getPlan(), rejection: null, isLoading: false };
  } catch (error) {
    if (!(error instanceof Rejection)) throw error;
    const isNone = error.problem.code === "PLAN_MISSING";
    return { plan: null, rejection: isNone ? null : error, isLoading: false };
  }
}
