import { Progress } from "@mantine/core";
import type { ReactNode } from "react";
import { formatNumber } from "../../live/rounding";
import type { CheckRecord } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { interpolate } from "../../texts/interpolate";

/** Distance of the tip from the planned landmark, with its limit and direction. */
export function CheckOutcome({ outcome }: { outcome: CheckRecord }): ReactNode {
  const texts = useTexts().check;
  const [left = 0, back = 0, head = 0] = outcome.off_lps_mm;
  const way = (mm: number, plus: string, minus: string): string =>
    `${formatNumber(Math.abs(mm), 1)} mm ${mm < 0 ? minus : plus}`;
  return (
    <div className="outcome" data-passed={outcome.passed} data-testid="check-outcome" role="status">
      <p className="outcome-state">
        <span aria-hidden="true">{outcome.passed ? "✓" : "▲▲"}</span>{" "}
        {outcome.passed ? texts.passed : texts.failed}
      </p>
      <p className="outcome-figure">
        {formatNumber(outcome.distance_mm, 1)} <span className="unit">mm</span>
        <small>
          {texts.allowed} {formatNumber(outcome.max_mm, 1)} mm
        </small>
      </p>
      <Progress
        size="xl"
        color={outcome.passed ? "teal" : "yellow"}
        value={Math.min(100, (100 * outcome.distance_mm) / outcome.max_mm)}
        aria-label={texts.distance}
      />
      <p>
        {texts.off}: {way(left, texts.left, texts.right)} · {way(back, texts.back, texts.front)} ·{" "}
        {way(head, texts.head, texts.feet)}
      </p>
      <p className="quiet">
        {interpolate(texts.sure, { sd: formatNumber(outcome.sd_mm, 1), images: outcome.images })}
      </p>
      {!outcome.passed && <p>{texts.failedRemedy}</p>}
    </div>
  );
}
