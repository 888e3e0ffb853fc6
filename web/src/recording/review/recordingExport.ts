// Result of an export job and its text. Pure.
import { formatBytes } from "../../operator/parts/format";
import type { Job } from "../../rest/useJob";
import type { Texts } from "../../texts/catalogue";
import { pluralize } from "../../texts/pluralize";
import { clockDuration } from "../recordingText";

/** A section has `is_exact` and `from_s`, a video `images_without_overlay`. */
export interface RecordingExport {
  file: string;
  size_bytes: number;
  images: number;
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
  const {
    images,
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
