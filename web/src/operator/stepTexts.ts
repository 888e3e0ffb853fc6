// Texts of a step's state. Navigation that may start is "ready", not "done".
import type { Texts } from "../texts/catalogue";
import type { OperatorTexts } from "../texts/operator/en";
import { pluralize } from "../texts/pluralize";
import type { Step } from "../app/procedure";

export function stateText(
  { step, state, code }: Pick<Step, "step" | "state" | "code">,
  texts: OperatorTexts,
): string {
  if (code === "PLAN_OF_REHEARSAL") return texts.ofRehearsal;
  return step === "navigate" && state === "done" ? texts.ready : texts.state[state];
}

/** What a valid step does not allow; empty if it allows everything. */
export function stepNote(
  { step, state, numbers }: Pick<Step, "step" | "state" | "numbers">,
  minLandmarks: number | null,
  { operator: texts, language }: Pick<Texts, "operator" | "language">,
): string {
  const there = numbers["landmarks"];
  const isFew =
    step === "plan" &&
    state === "done" &&
    typeof there === "number" &&
    minLandmarks !== null &&
    there < minLandmarks;
  return isFew ? pluralize(texts.fewLandmarks, there, language, { min: minLandmarks }) : "";
}
