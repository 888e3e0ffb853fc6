import type { ReactNode } from "react";
import { formatPercent } from "../../live/rounding";
import { useTexts } from "../../texts/TextsContext";

interface ScoreBarProps {
  name: string;
  ratio: number | null;
  /** Score from which the marker counts as found. */
  acceptRatio: number;
}

/** A score as in the paper's program, with its threshold. */
export function ScoreBar({ name, ratio, acceptRatio }: ScoreBarProps): ReactNode {
  const texts = useTexts().case.measure;
  const accepted = ratio !== null && ratio >= acceptRatio;
  return (
    <div className="score" data-accepted={ratio === null ? undefined : accepted}>
      <span className="score-name">{name}</span>
      <span className="score-bar" aria-hidden="true">
        <span className="score-fill" style={{ width: `${String(100 * (ratio ?? 0))}%` }} />
        <span className="score-accept" style={{ left: `${String(100 * acceptRatio)}%` }} />
      </span>
      <span className="score-value">
        {ratio === null ? "—" : `${accepted ? "✓" : "✕"} ${formatPercent(ratio)}`}
        <span className="soft">
          {" "}
          {texts.min} {formatPercent(acceptRatio)}
        </span>
      </span>
    </div>
  );
}
