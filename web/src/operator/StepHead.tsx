import type { ReactNode } from "react";
import { RefusalNote } from "../rest/RefusalNote";
import { useWords } from "../words/WordsContext";
import type { OperatorPage } from "./pages";
import { useProcedure } from "./procedure";

/** What a step is for, how it stands, and what to do next, as the server says it. */
export function StepHead({ page }: { page: OperatorPage }): ReactNode {
  const words = useWords().operator;
  const { data, refusal } = useProcedure();
  const step = data?.steps.find((one) => one.step === page.step) ?? null;
  return (
    <header className="step-head">
      <h2>{words.page[page.name]}</h2>
      <RefusalNote refusal={refusal} />
      {step !== null && (
        <p data-state={step.state} data-testid="step-said">
          <strong>{words.state[step.state]}</strong> · {step.said}
          {step.remedy !== "" && <span className="step-remedy"> {step.remedy}</span>}
        </p>
      )}
    </header>
  );
}
