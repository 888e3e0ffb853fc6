import type { Step } from "../../app/procedure";

/** The steps before navigation that are not done. */
export function openSteps(steps: readonly Step[]): Step[] {
  return steps.filter((one) => one.step !== "navigate" && one.state !== "done");
}
