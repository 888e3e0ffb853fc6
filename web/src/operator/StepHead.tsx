import { useEffect, useRef, type ReactNode, type RefObject } from "react";
import { useLocation } from "wouter";
import { RejectionNote } from "../rest/RejectionNote";
import { useTexts } from "../texts/TextsContext";
import { NextStep } from "./NextStep";
import type { OperatorPage } from "./pages";
import { useGates } from "./parts/useGates";
import { bringIntoView } from "./parts/useIntoView";
import { useProcedure } from "../app/procedure";
import { MARK_OF_STATE } from "./stepMarks";
import { stateText, stepNote } from "./stepTexts";

/** A remedy that names an address of the API is for programs: whoever is here has the page's own buttons. */
const FOR_MACHINES = "/api/";

/** What a step is for, its state with its numbers, and what to do next, as the server says it. */
export function StepHead({ page }: { page: OperatorPage }): ReactNode {
  const all = useTexts();
  const texts = all.operator;
  const { data, rejection } = useProcedure();
  const gates = useGates().data;
  const head = useArrival();
  const step = data?.steps.find((one) => one.step === page.step) ?? null;
  const note = step === null ? "" : stepNote(step, gates?.registration.min_points ?? null, all);
  // Where navigation is open, its page says below that all steps hold, and by what.
  const isSaidByGates = step?.step === "navigate" && step.state === "done";
  return (
    <header className="step-head" ref={head}>
      <div className="step-title">
        <h2>{texts.page[page.name]}</h2>
        <NextStep page={page} />
      </div>
      <RejectionNote rejection={rejection} />
      {step !== null && !isSaidByGates && (
        <p className="step-said" data-state={step.state} data-testid="step-said">
          <strong>
            <span aria-hidden="true">{MARK_OF_STATE[step.state]}</span> {stateText(step, texts)}
          </strong>{" "}
          {/* The server speaks English. */}
          <span lang="en">{sentence(step.message)}</span>{" "}
          {note !== "" && (
            <span className="step-remedy" data-testid="step-note">
              ▲ {note}
            </span>
          )}
          {step.remedy !== "" && !step.remedy.includes(FOR_MACHINES) && (
            <span className="step-remedy" lang="en">
              {step.remedy}
            </span>
          )}
        </p>
      )}
    </header>
  );
}

/** Whoever goes on to another step begins at its head, wherever the last one was left. */
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

/** The server's sentences begin small and have no full stop. */
function sentence(said: string): string {
  return said === "" ? "" : `${said.charAt(0).toUpperCase()}${said.slice(1)}.`;
}
