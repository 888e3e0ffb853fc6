// Result of an export job and its text. Pure.
import { formatBytes } from "../../operator/parts/format";
import type { Job } from "../../rest/useJob";
import type { Texts } from "../../texts/catalogue";
import { pluralize } from "../../texts/pluralize";
import { clockDuration } from "../recordingText";

/** A section has `is_exact`, a video `images_without_overlay`, tables `rows`, a sequence `frames`. */
export interface RecordingExport {
  file: string;
  size_bytes: number;
  images?: number;
  rows?: number;
  frames?: Record<string, string>;
  invalid_images?: number;
  from_s?: number;
  is_exact?: boolean;
  missing_images?: number;
  images_without_overlay?: number;
}

/** Null if the job failed or was cancelled. */
export const exportOf = (job: Job): RecordingExport | null =>
  job.state === "done" ? (job.result as RecordingExport) : null;

/** "120 images, 120 with the overlay. 14.0 MB" */
export function exportText(made: RecordingExport, texts: Texts): string {
  const own = texts.recording.review.exports;
  if (made.rows !== undefined)
    return `${pluralize(own.tablesMade, made.rows, texts.language)} ${formatBytes(made.size_bytes)}`;
  if (made.frames !== undefined) return sequenceText(made, made.frames, texts);
  const {
    images = 0,
    is_exact,
    from_s = 0,
    images_without_overlay: withoutOverlay = 0,
    missing_images: missing = 0,
  } = made;
  const template = is_exact === undefined ? own.videoMade : is_exact ? own.pieceMade : own.pieceInexact;
  const parts = [
    pluralize(template, images, texts.language, {
      drawn: images - withoutOverlay,
      from: clockDuration(from_s),
    }),
  ];
  if (missing > 0) parts.push(pluralize(own.missing, missing, texts.language));
  else if (is_exact === true) parts.push(own.exact);
  if (withoutOverlay > 0) parts.push(own.withoutOverlay);
  return `${parts.join(" ")} ${formatBytes(made.size_bytes)}`;
}

/** "12 images with the poses DrillToTracker, VertebraToTracker. 14.0 MB" */
function sequenceText(made: RecordingExport, frames: Record<string, string>, texts: Texts): string {
  const own = texts.recording.review.exports;
  const { images = 0, invalid_images: invalid = 0 } = made;
  const names = Object.values(frames).map((frame) => `${frame}ToTracker`);
  const parts = [pluralize(own.sequenceMade, images, texts.language, { names: names.join(", ") })];
  if (invalid > 0) parts.push(pluralize(own.sequenceInvalid, invalid, texts.language));
  return `${parts.join(" ")} ${formatBytes(made.size_bytes)}`;
}
