// Needles marked by hand: first the end at the bone, then the head.
import type { Px } from "./overlay";

export interface Mark {
  entry_px: [number, number];
  head_px: [number, number];
}

/** An end of a needle. */
export interface End {
  needle: number;
  end: "entry_px" | "head_px";
}

/** Marks; the last needle may have only its first end. */
export type Marking = Partial<Mark> & Pick<Mark, "entry_px">;

/** The next end to mark; null when all needles are complete. */
export function nextEnd(marks: readonly Mark[], open: number[] | null, needles: number): End | null {
  if (open !== null) return { needle: marks.length, end: "head_px" };
  return marks.length < needles ? { needle: marks.length, end: "entry_px" } : null;
}

export function withEnd(marks: readonly Mark[], { needle, end }: End, at: Px): Mark[] {
  return marks.map((mark, index) => (index === needle ? { ...mark, [end]: [...at] } : mark));
}

/** The end nearest to a touch, within the tolerance for gloves. */
export function endNear(marks: readonly Mark[], [x, y]: Px, withinPx: number): End | null {
  let [best, nearest]: [End | null, number] = [null, withinPx];
  marks.forEach((mark, needle) => {
    for (const end of ["entry_px", "head_px"] as const) {
      const [endX, endY] = mark[end];
      const far = Math.hypot(endX - x, endY - y);
      if (far <= nearest) [best, nearest] = [{ needle, end }, far];
    }
  });
  return best;
}
