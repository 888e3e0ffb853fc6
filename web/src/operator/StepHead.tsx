import { useEffect, useRef, type ReactNode, type RefObject } from "react";
import { useLocation } from "wouter";
import { RejectionNote } from "../rest/RejectionNote";
import { useTexts } from "../texts/TextsContext";
import { GatesOpen } from "./navigate/GatesOpen";
import { NextStep } from "./NextStep";
import type { OperatorPage } from "./pages";
import { sentence } from "./parts/format";
import { useGates } from "./parts/useGates";
import { bringIntoView } from "./parts/useIntoView";
import { useProcedure } from "../app/procedure";
import { MARK_OF_STATE } from "./stepMarks";
import { stateText, stepNote } from "./stepTexts";

/** A remedy with an API address is for programs; the page has its own buttons. */
const FOR_MACHINES = "/api/";

/** State of a step with its reason and remedy, as stated by the server. */
export function StepHead({ page }: { page: OperatorPage }): ReactNode {
  const all = useTexts();
  const texts = all.operator;
  const { data, rejection } = useProcedure();
  const gates = useGates().data;
  const head = useArrival();
  const step = data?.steps.find((one) => one.step === page.step) ?? null;
  const note = step === null ? "" : stepNote(step, gates?.registration.min_points ?? null, all);
  // While navigation is allowed, the passed gates say more than the state of the step.
  const isSaidByGates = step?.step === "navigate" && step.state === "done";
  return (
    <header className="step-head" ref={head}>
      <div className="step-title">
        <h2>{texts.page[page.name]}</h2>
        <NextStep page={page} />
      </div>
      <RejectionNote rejection={rejection} />
      {isSaidByGates && <GatesOpen />}
      {step !== null && !isSaidByGates && (
        <p className="step-said" data-state={step.state} data-testid="step-said">
          <strong>
            <span aria-hidden="true">{MARK_OF_STATE[step.state]}</span> {stateText(step, texts)}
          </strong>{" "}
          <span lang={step.language}>{sentence(step.message)}</span>{" "}
          {note !== "" && (
            <span className="step-remedy" data-testid="step-note">
              ▲ {note}
            </span>
          )}
          {step.remedy !== "" && !step.remedy.includes(FOR_MACHINES) && (
            <span className="step-remedy" lang={step.language}>
              {step.remedy}
            </span>
          )}
        </p>
      )}
    </header>
  );
}

/** Scrolls to the head of a step when the page changes. */
function useArrival(): RefObject<HTMLElement | null> {
  const [path] = useLocation();
  const head = useRef<HTMLElement>(null);
  const before = useRef(path);
  useEffect(() => {
    if (before.current === path || head.current === null) return;
    before.current = path;
    bringIntoView(head.current);
  }, [path]);
  return head;
}
