// The state of a step, in words that are true of it: navigation that may begin has not been done.
import type { OperatorTexts } from "../texts/operator/en";
import { interpolate } from "../texts/interpolate";
import type { Step } from "../app/procedure";

export function stateText({ step, state }: Pick<Step, "step" | "state">, texts: OperatorTexts): string {
  return step === "navigate" && state === "done" ? texts.ready : texts.state[state];
}

/** What a step that holds still does not allow; empty where it allows all. */
export function stepNote(
  { step, state, numbers }: Pick<Step, "step" | "state" | "numbers">,
  minLandmarks: number | null,
  texts: OperatorTexts,
): string {
  const there = numbers["landmarks"];
  const isFew =
    step === "plan" &&
    state === "done" &&
    typeof there === "number" &&
    minLandmarks !== null &&
    there < minLandmarks;
  return isFew ? interpolate(texts.fewLandmarks, { there, min: minLandmarks }) : "";
}
