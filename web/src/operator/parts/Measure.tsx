import type { ReactNode } from "react";
import { NOT_KNOWN, formatFigure } from "../../live/rounding";
import { useTexts } from "../../texts/TextsContext";

export interface Limit {
  kind: "max" | "min";
  value: number;
}

interface MeasureProps {
  name: string;
  value: number | null;
  unit: string;
  decimals?: number;
  /** Its limit; without one it is only shown. */
  limit?: Limit;
  /** The limit lets it pass by a bar as well: how far it is on its way. */
  bar?: boolean;
  testId?: string;
}

/** Whether a value is within its limit; null where there is none to hold it against. */
export function isWithin(value: number | null, limit: Limit | undefined): boolean | null {
  if (value === null || limit === undefined || !Number.isFinite(value)) return null;
  return limit.kind === "max" ? value <= limit.value : value >= limit.value;
}

/** A number with its unit and its limit, and in a sign and a word whether it holds. */
export function Measure({ name, value, unit, decimals = 2, limit, bar, testId }: MeasureProps): ReactNode {
  const texts = useTexts().case.measure;
  const within = isWithin(value, limit);
  const shown = value === null ? NOT_KNOWN : formatFigure(value, decimals);
  const interpolate =
    limit === undefined || value === null ? 0 : Math.min(1, Math.max(0, value / limit.value));
  return (
    <div className="measure" data-within={within ?? undefined} data-testid={testId}>
      <dt>{name}</dt>
      <dd>
        <span className="measure-value">
          {shown} <span className="unit">{unit}</span>
        </span>
        {limit !== undefined && (
          <span className="measure-limit">
            {within !== null && (
              <span className="measure-mark" role="img" aria-label={within ? texts.holds : texts.fails}>
                {within ? "✓" : "✕"}
              </span>
            )}
            {limit.kind === "max" ? texts.max : texts.min} {formatFigure(limit.value, decimals)} {unit}
          </span>
        )}
        {bar === true && (
          <span className="measure-bar" aria-hidden="true">
            <span style={{ width: `${String(interpolate * 100)}%` }} />
          </span>
        )}
      </dd>
    </div>
  );
}
