// How a step stands, in words that are true of it: navigation that may begin has not been done.
import type { OperatorWords } from "../words/operator/en";
import { filled } from "../words/filled";
import type { Step } from "../app/procedure";

export function stateWord({ step, state }: Pick<Step, "step" | "state">, words: OperatorWords): string {
  return step === "navigate" && state === "done" ? words.ready : words.state[state];
}

/** What a step that holds still does not allow; empty where it allows all. */
export function stepNote(
  { step, state, numbers }: Pick<Step, "step" | "state" | "numbers">,
  minLandmarks: number | null,
  words: OperatorWords,
): string {
  const there = numbers["landmarks"];
  const isFew =
    step === "plan" &&
    state === "done" &&
    typeof there === "number" &&
    minLandmarks !== null &&
    there < minLandmarks;
  return isFew ? filled(words.fewLandmarks, { there, least: minLandmarks }) : "";
}
