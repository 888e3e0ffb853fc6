import { Progress } from "@mantine/core";
import type { ReactNode } from "react";
import { shownNumber } from "../../live/rounding";
import type { components } from "../../schema";
import { useWords } from "../../words/WordsContext";
import { filled } from "../../words/filled";

/** How far the tip is from where the plan has the landmark, against what is allowed, and which way. */
export function CheckOutcome({ outcome }: { outcome: components["schemas"]["CheckRecord"] }): ReactNode {
  const words = useWords().check;
  const [left = 0, back = 0, head = 0] = outcome.off_lps_mm;
  const way = (mm: number, plus: string, minus: string): string =>
    `${shownNumber(Math.abs(mm), 1)} mm ${mm < 0 ? minus : plus}`;
  return (
    <div className="outcome" data-passed={outcome.passed} data-testid="check-outcome" role="status">
      <p className="outcome-state">
        <span aria-hidden="true">{outcome.passed ? "✓" : "▲▲"}</span>{" "}
        {outcome.passed ? words.passed : words.failed}
      </p>
      <p className="outcome-figure">
        {shownNumber(outcome.distance_mm, 1)} <span className="unit">mm</span>
        <small>
          {words.allowed} {shownNumber(outcome.max_mm, 1)} mm
        </small>
      </p>
      <Progress
        size="xl"
        color={outcome.passed ? "teal" : "yellow"}
        value={Math.min(100, (100 * outcome.distance_mm) / outcome.max_mm)}
        aria-label={words.distance}
      />
      <p>
        {words.off}: {way(left, words.left, words.right)} · {way(back, words.back, words.front)} ·{" "}
        {way(head, words.head, words.feet)}
      </p>
      <p className="quiet">
        {filled(words.sure, { sd: shownNumber(outcome.sd_mm, 1), images: outcome.images })}
      </p>
      {!outcome.passed && <p>{words.failedRemedy}</p>}
    </div>
  );
}
