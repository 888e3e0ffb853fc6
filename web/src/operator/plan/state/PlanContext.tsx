// The plan: one change at a time, with undo and redo.
import { createContext, use, useCallback, useState, type ReactNode } from "react";
import { getCasesByCaseIdDocumentsByDocumentId, putPlan } from "../../../api";
import { Rejection } from "../../../rest/client";
import { useAction } from "../../../rest/useAction";
import { useMadeBy } from "./madeBy";
import { vertebraeOf, type PlanAnswer, type Side, type Vertebra } from "./shape";
import { afterRedo, afterUndo, lastStep, read, withChange, type History } from "./undo";
import { useClearances, type Clearances } from "./useClearances";
import { usePlan } from "./usePlan";

interface By {
  made_by: string;
  expected_version: number;
}

interface PlanValue {
  caseId: string;
  plan: PlanAnswer | null;
  planRejection: Rejection | null;
  /** Whether the first answer is pending. */
  isLoading: boolean;
  askAgain: () => void;
  vertebrae: Vertebra[];
  /** The selected vertebra; null if there is none. */
  vertebra: Vertebra | null;
  side: Side;
  /** Clearance of each screw to the wall; null while unknown. */
  clearances: Clearances | null;
  busy: boolean;
  rejection: Rejection | null;
  /** Who changed the plan in between, after a change here was rejected for it. */
  conflict: PlanAnswer["heading"] | null;
  setVertebra: (name: string) => void;
  setSide: (side: Side) => void;
  /** Applies a change to the displayed version; true if it was stored. */
  change: (action: (by: By) => Promise<PlanAnswer>) => Promise<boolean>;
  /** A job has changed the plan and made this version. */
  changedTo: (madeVersion: number, documentBefore: string | null) => void;
  by: By;
  canUndo: boolean;
  undo: () => void;
  canRedo: boolean;
  redo: () => void;
  forget: () => void;
}

const PlanContext = createContext<PlanValue | null>(null);
const STEPS = "coaxial.plan.steps";

export function PlanProvider({ caseId, children }: { caseId: string; children: ReactNode }): ReactNode {
  const { plan, rejection: planRejection, isLoading, take, refetch } = usePlan(caseId);
  const clearances = useClearances(plan?.heading.id ?? null);
  const doing = useAction();
  const [history, setHistory] = useState<History>(() => read(sessionStorage.getItem(`${STEPS}.${caseId}`)));
  const [conflict, setConflict] = useState<PlanAnswer["heading"] | null>(null);
  const [chosen, setVertebra] = useState<string | null>(null);
  const [side, setSide] = useState<Side>("left");
  const madeBy = useMadeBy();

  const remember = (next: History): void => {
    setHistory(next);
    sessionStorage.setItem(`${STEPS}.${caseId}`, JSON.stringify(next));
  };
  const version = plan?.heading.version ?? 0;
  const by: By = { made_by: madeBy, expected_version: version };

  const run = async (action: () => Promise<PlanAnswer>): Promise<PlanAnswer | null> => {
    let made: PlanAnswer | null = null;
    setConflict(null);
    await doing.run(async () => {
      try {
        made = await action();
        take(made);
      } catch (error) {
        if (!(error instanceof Rejection) || error.problem.code !== "VERSION_CONFLICT") throw error;
        setConflict((await refetch())?.heading ?? null);
      }
    });
    return made;
  };
  const change = async (action: (by: By) => Promise<PlanAnswer>): Promise<boolean> => {
    const made = await run(() => action(by));
    if (made !== null && made.heading.version > version) {
      remember(withChange(history, plan?.heading.id ?? null, made.heading.version));
    }
    return made !== null;
  };
  const changedTo = (madeVersion: number, documentBefore: string | null): void => {
    remember(withChange(history, documentBefore, madeVersion));
    void refetch();
  };
  const toUndo = lastStep(history.done, version);
  const toRedo = lastStep(history.undone, version);
  const replace = (documentId: string | null, after: typeof afterUndo): void => {
    const replaced = plan?.heading.id ?? null;
    void run(async () => {
      const content = await contentOf(caseId, documentId, plan);
      return putPlan({ body: { ...by, plan: content } });
    }).then((made) => {
      if (made !== null) remember(after(history, replaced, made.heading.version));
    });
  };
  // Undo across CTs would transfer an older plan unseen.
  const isReplaceable = !doing.busy && plan?.heading.current !== false;
  const { forget: forgetDoing } = doing;
  const forget = useCallback(() => {
    setConflict(null);
    forgetDoing();
  }, [forgetDoing]);

  const vertebrae = vertebraeOf(plan);
  const value: PlanValue = {
    caseId,
    plan,
    planRejection,
    isLoading,
    askAgain: () => void refetch(),
    vertebrae,
    side,
    clearances,
    conflict,
    setVertebra,
    setSide,
    change,
    changedTo,
    by,
    canUndo: toUndo !== null && isReplaceable,
    undo: () => {
      if (toUndo !== null) replace(toUndo.documentId, afterUndo);
    },
    canRedo: toRedo !== null && isReplaceable,
    redo: () => {
      if (toRedo !== null) replace(toRedo.documentId, afterRedo);
    },
    forget,
    vertebra: vertebrae.find((one) => one.name === chosen) ?? vertebrae[0] ?? null,
    busy: doing.busy,
    rejection: doing.rejection,
  };
  return <PlanContext value={value}>{children}</PlanContext>;
}

/** The plan of an older document; empty if there was none. */
async function contentOf(
  caseId: string,
  documentId: string | null,
  plan: PlanAnswer | null,
): Promise<Record<string, unknown>> {
  if (documentId === null) return { format_version: plan?.plan["format_version"], vertebrae: [] };
  const path = { case_id: caseId, document_id: documentId };
  const document = await getCasesByCaseIdDocumentsByDocumentId({ path });
  return document.content;
}

export function usePlanning(): PlanValue {
  const value = use(PlanContext);
  if (value === null) throw new Error("usePlanning must be used inside PlanProvider");
  return value;
}
