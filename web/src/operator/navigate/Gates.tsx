import type { ReactNode } from "react";
import { Link } from "wouter";
import { QueryStatus } from "../../rest/QueryStatus";
import { useTexts } from "../../texts/TextsContext";
import { sentence } from "../parts/format";
import { StepActions } from "../StepActions";
import { stateText } from "../stepTexts";
import { openSteps } from "./openSteps";
import { useProcedure, type Step } from "../../app/procedure";

/** Steps that are not valid or due again, with reasons and links; otherwise the way to another check. */
export function Gates(): ReactNode {
  const texts = useTexts();
  const procedure = useProcedure();
  const { data } = procedure;
  if (data === null) return <QueryStatus query={procedure} />;
  // The head of the page states this already.
  if (data.case_id === null) return null;
  const open = openSteps(data.steps);
  if (open.length === 0)
    return (
      <StepActions>
        <Link className="big-link" href="/operator/check" data-testid="re-check">
          {texts.navigate.recheck}
        </Link>
      </StepActions>
    );
  return (
    <section className="card gates" data-testid="gates-shut">
      <h3>▲ {data.may_navigate ? texts.navigate.dueTitle : texts.navigate.shutTitle}</h3>
      <ul>
        {groupSteps(open).map((steps) => (
          <li key={steps.map((one) => one.step).join(" ")}>
            <span>
              <strong>
                {steps.map((one) => texts.operator.page[one.step]).join(", ")} ·{" "}
                {stateText(steps[0], texts.operator)}
              </strong>{" "}
              <span lang={steps[0].language}>{sentence(steps[0].message)}</span>
            </span>
            {steps.map((one) => (
              <Link key={one.step} className="big-link" href={`/operator/${one.step}`}>
                {texts.navigate.goTo} {texts.operator.page[one.step]}
              </Link>
            ))}
          </li>
        ))}
      </ul>
    </section>
  );
}

/** Groups adjacent steps with the same state and reason. */
function groupSteps(steps: readonly Step[]): [Step, ...Step[]][] {
  const groups: [Step, ...Step[]][] = [];
  for (const step of steps) {
    const last = groups.at(-1);
    if (last?.[0].message === step.message && last[0].state === step.state) last.push(step);
    else groups.push([step]);
  }
  return groups;
}
