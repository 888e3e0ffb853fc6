import { Progress } from "@mantine/core";
import type { ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import type { NudgesMessage } from "../../../api";
import { useTexts } from "../../../texts/TextsContext";

/** Sum of all nudges, with its limit. */
export function NudgeSums({ nudges }: { nudges: NudgesMessage }): ReactNode {
  const texts = useTexts().registration.nudges;
  const sums = [
    { name: texts.sumMm, value: nudges.shift_mm, max: nudges.max_mm, unit: "mm" },
    { name: texts.sumDeg, value: nudges.rotation_deg, max: nudges.max_deg, unit: "°" },
  ];
  return (
    <dl className="limits" data-testid="nudge-sums">
      {sums.map(({ name, value, max, unit }) => (
        <div className="limit" key={unit}>
          <dt>
            {name}
            <Progress size="lg" value={max > 0 ? Math.min(100, (100 * value) / max) : 0} aria-label={name} />
          </dt>
          <dd>
            <strong>
              {formatNumber(value, 1)} <span className="unit">{unit}</span>
            </strong>
            <small>
              {texts.allowed} {formatNumber(max, 1)} {unit}
            </small>
          </dd>
        </div>
      ))}
    </dl>
  );
}
