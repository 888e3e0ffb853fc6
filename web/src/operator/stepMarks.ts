import type { Step } from "../app/procedure";

/** A shape of its own for each state: the colour says nothing that the shape does not. */
export const MARK_OF_STATE: Record<Step["state"], string> = {
  done: "✓",
  due: "↻",
  missing: "○",
  out_of_date: "!",
  failed: "✕",
};
