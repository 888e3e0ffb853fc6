// How a number is shown. The server burns the same digits into the video (`server/number_format.py`).

export const NOT_KNOWN = "--";

/** Fixed decimals, half away from zero, never a negative zero, "--" for what is not a number. */
export function shownNumber(value: number | null, decimals = 1): string {
  if (value === null || !Number.isFinite(value)) return NOT_KNOWN;
  const text = value.toFixed(decimals);
  return Number(text) === 0 ? (0).toFixed(decimals) : text;
}

/** The same with a true minus sign, which is as wide as a digit and seen from 3 m. */
export function shownFigure(value: number | null, decimals = 1): string {
  return shownNumber(value, decimals).replace(/^-(?=\d)/, "\u2212");
}

export function shownPercent(ratio: number): string {
  return `${shownNumber(ratio * 100, 0)} %`;
}

/** Seconds with one decimal, for "NO TRACKING 1.2 s"; minutes once they are many. */
export function shownDuration(ms: number): string {
  const seconds = Math.max(ms, 0) / 1000;
  return seconds < 100 ? `${shownNumber(seconds)} s` : `${shownNumber(Math.floor(seconds / 60), 0)} min`;
}
