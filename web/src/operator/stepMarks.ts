import type { Step } from "../app/procedure";

/** A symbol for each state: colour never carries information alone. */
export const MARK_OF_STATE: Record<Step["state"], string> = {
  done: "✓",
  due: "↻",
  missing: "○",
  out_of_date: "!",
  failed: "✕",
};
