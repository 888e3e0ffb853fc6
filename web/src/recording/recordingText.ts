// Texts of the current or last recording. Pure.
import { formatBytes } from "../operator/parts/format";
import type { RecordingStateMessage } from "../api";
import { interpolate } from "../texts/interpolate";
import { pluralize } from "../texts/pluralize";
import type { RecordingTexts } from "../texts/recording/en";

export type Recording = RecordingStateMessage;

export interface RecordingText {
  state: "on" | "off" | "stopped";
  title: string;
  details: string[];
  /** Warnings: missing images, a disk that is nearly full. */
  warnings: string[];
  /** The server's reason if the page has no text for it; otherwise empty. */
  serverReason: string;
}

/** Remaining time below which disk space is a warning. */
const MIN_REMAINING_S = 600;

export function recordingText(recording: Recording, texts: RecordingTexts, language: string): RecordingText {
  const { problem } = recording;
  if (!recording.is_recording) {
    if (problem === null) {
      return { state: "off", title: texts.off, details: [], warnings: [], serverReason: "" };
    }
    const reason = texts.reasons[problem.code];
    return {
      state: "stopped",
      title: texts.stopped,
      details: reason === undefined ? [] : [reason],
      warnings: [],
      serverReason: reason === undefined ? problem.message : "",
    };
  }
  const { remaining_s, missing_images } = recording;
  const lasts = remaining_s === null ? "" : interpolate(texts.lasts, { time: roughDuration(remaining_s) });
  const isNearlyFull = remaining_s !== null && remaining_s < MIN_REMAINING_S;
  return {
    state: "on",
    title: `${texts.on} ${clockDuration(recording.duration_s)}`,
    details: [formatBytes(recording.size_bytes), isNearlyFull ? "" : lasts].filter((one) => one !== ""),
    warnings: [
      isNearlyFull ? lasts : "",
      missing_images > 0 ? pluralize(texts.missing, missing_images, language) : "",
    ].filter((one) => one !== ""),
    serverReason: "",
  };
}

/** Warnings first, since a narrow header truncates the end. */
export const detailsLine = ({ details, warnings }: RecordingText): string =>
  [...warnings.map((one) => `▲ ${one}`), ...details].join(" · ");

/** "0:07", "12:34", "1:02:03". */
export function clockDuration(seconds: number): string {
  const all = Math.max(0, Math.floor(seconds));
  const [h, min, s] = [Math.floor(all / 3600), Math.floor(all / 60) % 60, all % 60];
  const two = (value: number): string => String(value).padStart(2, "0");
  return h > 0 ? `${h}:${two(min)}:${two(s)}` : `${min}:${two(s)}`;
}

/** Rounded down to one unit, so that the remaining time is never overstated. */
export function roughDuration(seconds: number): string {
  if (seconds < 60) return "< 1 min";
  if (seconds < 3600) return `${Math.floor(seconds / 60)} min`;
  const hours = Math.floor(seconds / 3600);
  return hours < 100 ? `${hours} h` : "> 100 h";
}

/** With tenths of a second: "0:12.3". */
export function clockTenths(seconds: number): string {
  // Image times have rounding errors of a microsecond.
  const tenths = Math.floor(10 * seconds + 1e-4);
  return `${clockDuration(Math.floor(tenths / 10))}.${tenths % 10}`;
}
