// Texts of the course of a drilling. Pure.
import type { DrillingMessage, RecordedFigureMessage } from "../../api";
import { formatFigure, formatNumber } from "../../live/rounding";
import type { ReportTexts } from "../../texts/report/en";
import { interpolate } from "../../texts/interpolate";

/** "3.8 ± 0.21 mm"; without a known error it says so. */
export function figureText(
  { value, error_95 }: RecordedFigureMessage,
  unit: string,
  texts: ReportTexts["drilling"],
): string {
  if (value === null) return texts.unknown;
  const error = error_95 === null ? ` (${texts.errorUnknown})` : ` ± ${formatNumber(error_95, 2)}`;
  return error_95 === null
    ? `${formatFigure(value)}${gap(unit)}${error}`
    : `${formatFigure(value)}${error}${gap(unit)}`;
}

const gap = (unit: string): string => (unit === "°" ? unit : ` ${unit}`);

/** "B, up to C (95 %)". */
export function gradeText(
  { grade, worst_grade, against }: DrillingMessage,
  texts: ReportTexts["drilling"],
): string {
  if (grade === null) return against === "channel" ? texts.noGrade : texts.unknown;
  if (worst_grade === null) return `${grade} (${texts.errorUnknown})`;
  return worst_grade === grade
    ? interpolate(texts.gradeSame, { grade })
    : interpolate(texts.gradeUpTo, { grade, worst: worst_grade });
}

/** "1.2 s, longest 0.9 s". */
export function missingText(
  { missing_s, longest_missing_s }: DrillingMessage,
  texts: ReportTexts["drilling"],
): string {
  if (missing_s === 0) return texts.neverMissing;
  return interpolate(texts.missingFor, {
    total: formatNumber(missing_s),
    longest: formatNumber(longest_missing_s),
  });
}
