// Number formatting, identical to the server's in the video (`server/number_format.py`).

export const NOT_KNOWN = "--";

/** Fixed decimals, half away from zero, no negative zero, "--" for NaN. */
export function formatNumber(value: number | null, decimals = 1): string {
  if (value === null || !Number.isFinite(value)) return NOT_KNOWN;
  const text = value.toFixed(decimals);
  return Number(text) === 0 ? (0).toFixed(decimals) : text;
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
