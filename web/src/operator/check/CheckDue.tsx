import type { ReactNode } from "react";
import { shownNumber } from "../../live/rounding";
import type { components } from "../../schema";
import { useWords } from "../../words/WordsContext";
import { useProcedure } from "../procedure";
import { filled } from "../registration/filled";
import { minutesLeft } from "./due";

/** How the last check stands, and when the next is due. */
export function CheckDue({ rule }: { rule: components["schemas"]["CheckRuleMessage"] }): ReactNode {
  const words = useWords().check;
  const step = useProcedure().data?.steps.find((one) => one.step === "check");
  const left = minutesLeft(step?.numbers["age_min"], rule.again_after_min);
  const every = filled(words.every, { minutes: rule.again_after_min, most: shownNumber(rule.most_mm, 1) });
  if (step?.state === "due") return <p className="warning">▲ {words.dueNow}</p>;
  return (
    <p className="quiet" data-testid="check-due">
      {step?.state === "done" && left !== null
        ? `${filled(words.dueIn, { minutes: shownNumber(left, 0) })} ${every}`
        : every}
    </p>
  );
}
