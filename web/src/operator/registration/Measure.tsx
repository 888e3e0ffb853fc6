import type { ReactNode } from "react";
import { formatNumber } from "../../live/rounding";
import { useTexts } from "../../texts/TextsContext";

interface MeasureProps {
  name: string;
  value: number | null;
  unit: string;
  /** The limit; omitted if there is none. */
  max?: number | null | undefined;
  digits?: number;
  hint?: string;
}

/** A value with unit and limit; a word, a symbol and a colour state whether it is within. */
export function Measure({ name, value, unit, max, digits = 2, hint }: MeasureProps): ReactNode {
  const texts = useTexts().registration.measure;
  const limited = max !== undefined && max !== null;
  const isWithinLimit = value === null || !limited ? null : value <= max;
  return (
    <div className="limit" data-within={isWithinLimit ?? undefined}>
      <dt>
        {name}
        {hint !== undefined && <small>{hint}</small>}
      </dt>
      <dd>
        <strong className="whole">
          {value === null ? "—" : formatNumber(value, digits)} <span className="unit">{unit}</span>
        </strong>
        {limited && (
          <small>
            {isWithinLimit !== null && (
              <b>
                <span aria-hidden="true">{isWithinLimit ? "✓" : "▲"}</span>{" "}
                {isWithinLimit ? texts.within : texts.over} ·{" "}
              </b>
            )}
            {texts.allowed}{" "}
            <span className="whole">
              {formatNumber(max, digits)} {unit}
            </span>
          </small>
        )}
      </dd>
    </div>
  );
}
