// The state of a step, in words that are true of it: navigation that may begin has not been done.
import type { Texts } from "../texts/catalogue";
import type { OperatorTexts } from "../texts/operator/en";
import { pluralize } from "../texts/pluralize";
import type { Step } from "../app/procedure";

export function stateText({ step, state }: Pick<Step, "step" | "state">, texts: OperatorTexts): string {
  return step === "navigate" && state === "done" ? texts.ready : texts.state[state];
}

/** What a step that holds still does not allow; empty where it allows all. */
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
