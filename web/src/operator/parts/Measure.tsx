import type { ReactNode } from "react";
import { NOT_KNOWN, formatFigure } from "../../live/rounding";
import { useTexts } from "../../texts/TextsContext";

interface Limit {
  kind: "max" | "min";
  value: number;
}

interface MeasureProps {
  name: string;
  value: number | null;
  unit: string;
  decimals?: number;
  /** The limit; without one the value is only shown. */
  limit?: Limit;
  /** Also shows progress towards the limit as a bar. */
  bar?: boolean;
  testId?: string;
}

/** Whether a value is within its limit; null without a limit. */
export function isWithin(value: number | null, limit: Limit | undefined): boolean | null {
  if (value === null || limit === undefined || !Number.isFinite(value)) return null;
  return limit.kind === "max" ? value <= limit.value : value >= limit.value;
}

/** A value with unit and limit; a symbol and a word state whether it is within. */
export function Measure({ name, value, unit, decimals = 2, limit, bar, testId }: MeasureProps): ReactNode {
  const texts = useTexts().case.measure;
  const within = isWithin(value, limit);
  const shown = value === null ? NOT_KNOWN : formatFigure(value, decimals);
  const progress = limit === undefined || value === null ? 0 : Math.min(1, Math.max(0, value / limit.value));
  return (
    <div className="measure" data-within={within ?? undefined} data-testid={testId}>
      <dt>{name}</dt>
      <dd>
        <span className="measure-value whole">
          {shown} <span className="unit">{unit}</span>
        </span>
        {limit !== undefined && (
          <span className="measure-limit">
            {within !== null && (
              <span className="measure-mark" role="img" aria-label={within ? texts.holds : texts.fails}>
                {within ? "✓" : "✕"}
              </span>
            )}
            {limit.kind === "max" ? texts.max : texts.min}{" "}
            <span className="whole">
              {formatFigure(limit.value, decimals)} {unit}
            </span>
          </span>
        )}
        {bar === true && (
          <span className="measure-bar" aria-hidden="true">
            <span style={{ width: `${String(progress * 100)}%` }} />
          </span>
        )}
      </dd>
    </div>
  );
}
