import type { ReactNode } from "react";
import { useProcedure, type Step } from "../app/procedure";
import { stateWord } from "../operator/stepWords";
import { Unanswered } from "../rest/Unanswered";
import { useWords } from "../words/WordsContext";

const SYMBOL: Record<Step["state"], string> = {
  done: "✓",
  due: "↻",
  missing: "○",
  out_of_date: "!",
  failed: "✕",
};

/** How every step of the procedure stands, in the server's own sentences. */
export function StepsShown(): ReactNode {
  const words = useWords();
  const asked = useProcedure();
  const { data } = asked;
  const own = words.supervisor;
  if (data === null) return <Unanswered asked={asked} />;
  if (data.case_id === null) return <p className="soft">{own.steps.noCase}</p>;
  return (
    <ol className="steps-shown" data-testid="steps">
      {data.steps.map((step) => (
        <li
          key={step.step}
          data-state={step.missing_cosignature === null ? step.state : "missing"}
          data-step={step.step}
        >
          <span aria-hidden="true" className="steps-mark">
            {step.missing_cosignature === null ? SYMBOL[step.state] : "○"}
          </span>
          <div>
            <b>{words.operator.page[step.step]}</b> ·{" "}
            {step.missing_cosignature === null ? stateWord(step, words.operator) : own.steps.lacks}
            <p className="soft">{step.message}</p>
          </div>
        </li>
      ))}
    </ol>
  );
}
