// Numbers as the page's language writes them, with the digits of the server (`server/number_format.py`).
import { pageLanguage } from "../texts/pageLanguage";

export const NOT_KNOWN = "--";

/** Between the whole and the decimals: a point, in German a comma. */
export const decimalSign = (): "." | "," => (pageLanguage() === "de" ? "," : ".");

/** Fixed decimals, half away from zero, no negative zero, "--" for NaN. */
export function formatNumber(value: number | null, decimals = 1): string {
  if (value === null || !Number.isFinite(value)) return NOT_KNOWN;
  const text = value.toFixed(decimals);
  return withDecimalSign(Number(text) === 0 ? (0).toFixed(decimals) : text);
}

/** All decimals that the number has: sizes of a catalogue, steps. */
export function formatExact(value: number): string {
  return withDecimalSign(String(value));
}

/** A count, with its thousands apart by a narrow space, which no language reads as a decimal sign. */
export function formatCount(value: number): string {
  return value.toFixed(0).replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

function withDecimalSign(digits: string): string {
  return digits.replace(".", decimalSign());
}

/** With a true minus sign, which is as wide as a digit and legible from 3 m. */
export function formatFigure(value: number | null, decimals = 1): string {
  return formatNumber(value, decimals).replace(/^-(?=\d)/, "\u2212");
}

export function formatPercent(ratio: number): string {
  return `${formatNumber(ratio * 100, 0)} %`;
}

/** Seconds with one decimal, as in "NO TRACKING 1.2 s"; minutes when large. */
export function formatDuration(ms: number): string {
  const seconds = Math.max(ms, 0) / 1000;
  return seconds < 100 ? `${formatNumber(seconds)} s` : `${formatNumber(Math.floor(seconds / 60), 0)} min`;
}
