// A gate's numbers come with their unit at the end of their name; on paper it stands behind the value.
import { shownFigure } from "../../live/rounding";

type Value = number | boolean | string | null | undefined;

const UNITS: readonly [suffix: string, unit: string, decimals: number][] = [
  ["_mm", "mm", 2],
  ["_deg", "°", 2],
  ["_px", "px", 2],
  ["_min", "min", 0],
  ["_s", "s", 1],
  ["_ms", "ms", 0],
  ["_hz", "Hz", 1],
];

/** `rms_px: 0.123` is `["rms", "0.12 px"]`; what is not known is left out. */
export function shownNumbers(numbers: Readonly<Record<string, Value>>): [name: string, shown: string][] {
  return Object.entries(numbers).flatMap(([key, value]) => {
    const shown = shownValue(key, value);
    return shown === null ? [] : [[bare(key), shown]];
  });
}

function bare(key: string): string {
  if (key.endsWith("_ratio")) return key.slice(0, -"_ratio".length);
  const unit = UNITS.find(([suffix]) => key.endsWith(suffix));
  return unit === undefined ? key : key.slice(0, -unit[0].length);
}

function shownValue(key: string, value: Value): string | null {
  if (value === null || value === undefined || value === "") return null;
  if (typeof value === "boolean") return value ? "✓" : "✕";
  if (typeof value === "string") return value;
  if (!Number.isFinite(value)) return null;
  if (key.endsWith("_ratio")) return `${shownFigure(100 * value, 0)} %`;
  const unit = UNITS.find(([suffix]) => key.endsWith(suffix));
  if (unit !== undefined) return `${shownFigure(value, unit[2])} ${unit[1]}`;
  return shownFigure(value, Number.isInteger(value) ? 0 : 2);
}
