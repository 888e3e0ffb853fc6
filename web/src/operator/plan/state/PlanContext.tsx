// The plan: one change at a time, with undo.
import { createContext, use, useCallback, useState, type ReactNode } from "react";
import { getCasesByCaseIdDocumentsByDocumentId, putPlan } from "../../../api";
import { Rejection } from "../../../rest/client";
import { useAction } from "../../../rest/useAction";
import { useMadeBy } from "./madeBy";
import { vertebraeOf, type PlanAnswer, type Side, type Vertebra } from "./shape";
import { lastStep, read, withChange, withoutLast, type Step } from "./undo";
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
  forget: () => void;
}

const PlanContext = createContext<PlanValue | null>(null);
const STEPS = "coaxial.plan.steps";

export function PlanProvider({ caseId, children }: { caseId: string; children: ReactNode }): ReactNode {
  const { plan, rejection: planRejection, isLoading, take, refetch } = usePlan(caseId);
  const doing = useAction();
  const [steps, setSteps] = useState<Step[]>(() => read(sessionStorage.getItem(`${STEPS}.${caseId}`)));
  const [conflict, setConflict] = useState<PlanAnswer["heading"] | null>(null);
  const [chosen, setVertebra] = useState<string | null>(null);
  const [side, setSide] = useState<Side>("left");
  const madeBy = useMadeBy();

  const storeView = (next: Step[]): void => {
    setSteps(next);
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
      storeView(withChange(steps, plan?.heading.id ?? null, made.heading.version));
    }
    return made !== null;
  };
  const changedTo = (madeVersion: number, documentBefore: string | null): void => {
    storeView(withChange(steps, documentBefore, madeVersion));
    void refetch();
  };
  const step = lastStep(steps, version);
  const undo = (): void => {
    if (step === null) return;
    void run(async () => {
      const before = await contentOf(caseId, step.documentId, plan);
      return putPlan({ body: { ...by, plan: before } });
    }).then((made) => {
      if (made !== null) storeView(withoutLast(steps, made.heading.version));
    });
  };
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
    conflict,
    setVertebra,
    setSide,
    change,
    changedTo,
    by,
    undo,
    forget,
    vertebra: vertebrae.find((one) => one.name === chosen) ?? vertebrae[0] ?? null,
    busy: doing.busy,
    rejection: doing.rejection,
    // Undo across CTs would transfer an older plan unseen.
    canUndo: step !== null && !doing.busy && plan?.heading.current !== false,
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
