import type { ReactNode } from "react";
import { RefusalNote } from "../rest/RefusalNote";
import { useWords } from "../words/WordsContext";
import { NextStep } from "./NextStep";
import type { OperatorPage } from "./pages";
import { useProcedure } from "./procedure";
import { MARK_OF_STATE } from "./stepMarks";

/** A remedy that names an address of the API is for programs: whoever is here has the page's own buttons. */
const FOR_MACHINES = "/api/";

/** What a step is for, how it stands with its numbers, and what to do next, as the server says it. */
export function StepHead({ page }: { page: OperatorPage }): ReactNode {
  const words = useWords().operator;
  const { data, refusal } = useProcedure();
  const step = data?.steps.find((one) => one.step === page.step) ?? null;
  return (
    <header className="step-head">
      <div className="step-title">
        <h2>{words.page[page.name]}</h2>
        <NextStep page={page} />
      </div>
      <RefusalNote refusal={refusal} />
      {step !== null && (
        <p className="step-said" data-state={step.state} data-testid="step-said">
          <strong>
            <span aria-hidden="true">{MARK_OF_STATE[step.state]}</span> {words.state[step.state]}
          </strong>{" "}
          {/* The server speaks English. */}
          <span lang="en">{sentence(step.said)}</span>
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

/** The server's sentences begin small and have no full stop. */
function sentence(said: string): string {
  return said === "" ? "" : `${said.charAt(0).toUpperCase()}${said.slice(1)}.`;
}
