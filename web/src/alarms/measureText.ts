import type { AlarmMessage } from "../live/messages";
import { shownNumber } from "../live/rounding";

type Measure = AlarmMessage["measure"];
const WHOLE = new Set(["MB", "min", ""]);

/** A number with its limit; empty where it is no matter of a number. */
export function measureText(measure: Measure, limitWord: string): string {
  if (measure === null || measure.unit === "") return "";
  const decimals = WHOLE.has(measure.unit) ? 0 : 1;
  const [value, limit] = [measure.value, measure.limit].map((number) => shownNumber(number, decimals));
  return `${value} ${measure.unit} (${limitWord} ${limit} ${measure.unit})`;
}
