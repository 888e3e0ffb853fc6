// Formatting of times, sizes and sentences on the set-up pages.
import { formatNumber } from "../../live/rounding";

/** Local date and time, to the minute. */
export function formatTime(iso: string, language: string, zone?: string): string {
  return shownAs(iso, { dateStyle: "medium", timeStyle: "short" }, language, zone);
}

/** Local date and time to the second, for logs. */
export function formatSecond(iso: string, language: string, zone?: string): string {
  return shownAs(iso, { dateStyle: "medium", timeStyle: "medium" }, language, zone);
}

/** Time of day, to the second. */
export function formatClock(iso: string, language: string, zone?: string): string {
  return shownAs(iso, { timeStyle: "medium" }, language, zone);
}

/** An invalid time is shown unchanged. */
function shownAs(
  iso: string,
  form: Intl.DateTimeFormatOptions,
  language: string,
  zone: string | undefined,
): string {
  const at = new Date(iso);
  if (Number.isNaN(at.getTime())) return iso;
  const inZone = zone === undefined ? form : { ...form, timeZone: zone };
  return new Intl.DateTimeFormat(language === "en" ? "en-GB" : language, inZone).format(at);
}

/** In the unit that leaves one to three digits before the decimal point. */
export function formatBytes(bytes: number): string {
  const units = ["B", "kB", "MB", "GB"] as const;
  let size = bytes;
  let place = 0;
  while (size >= 1000 && place < units.length - 1) {
    size /= 1000;
    place += 1;
  }
  return `${formatNumber(size, place === 0 || size >= 100 ? 0 : 1)} ${units[place] ?? ""}`;
}

/** The server's sentences start in lower case, since they may follow others. */
export function sentence(text: string): string {
  const whole = text.charAt(0).toUpperCase() + text.slice(1);
  return /[.!?]$/.test(whole) || whole === "" ? whole : `${whole}.`;
}
