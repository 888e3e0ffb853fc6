import type { ReactNode } from "react";
import { useProcedure, type Step } from "../app/procedure";
import { sentence } from "../operator/parts/format";
import { stateText } from "../operator/stepTexts";
import { EmptyState } from "../panes/EmptyState";
import { QueryStatus } from "../rest/QueryStatus";
import { useTexts } from "../texts/TextsContext";

const SYMBOL: Record<Step["state"], string> = {
  done: "✓",
  due: "↻",
  missing: "○",
  out_of_date: "!",
  failed: "✕",
};

/** The state of each step, with its reason. */
export function StepsShown(): ReactNode {
  const texts = useTexts();
  const query = useProcedure();
  const { data } = query;
  const own = texts.supervisor;
  if (data === null) return <QueryStatus query={query} />;
  if (data.case_id === null) return <EmptyState drawing="case" sentence={own.steps.noCase} />;
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
            <b>{texts.operator.page[step.step]}</b> ·{" "}
            {step.missing_cosignature === null ? stateText(step, texts.operator) : own.steps.lacks}
            <p className="soft" lang={step.language}>
              {sentence(step.message)}
            </p>
          </div>
        </li>
      ))}
    </ol>
  );
}
