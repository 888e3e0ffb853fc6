// What stands beside the headline, from the figures. Pure, so that it is tested without a page.
import type { AssessmentMessage, Tone } from "../live/messages";
import { formatNumber } from "../live/rounding";
import type { Texts } from "../texts/en";

/** A shape of its own for each, as in the video: the colour says nothing that the shape does not. */
export const TONE_SYMBOL: Record<Tone, string> = {
  good: "●",
  caution: "▲",
  warning: "◆",
  danger: "✖",
  none: "○",
};

/** The probability of a breach, within 2 mm and by the screw at the end, with the limit of both. */
export function riskText({ figures }: AssessmentMessage, texts: Texts): string {
  const { risk, end } = figures;
  const parts = [
    risk.value === null ? "" : `${texts.wall.soon} ${formatNumber(risk.value, 0)} %`,
    end.value === null ? "" : `${texts.wall.atEnd} ${formatNumber(end.value, 0)} %`,
  ].filter((part) => part !== "");
  if (parts.length === 0) return "";
  return `${texts.wall.risk}: ${parts.join(", ")} · ${texts.theatre.limit} ${formatNumber(risk.limit, 0)} %`;
}

/** The error of the whole chain, marker, registration and tool, and what the pedicle leaves. */
export function errorText({ figures }: AssessmentMessage, texts: Texts): string {
  const { value, limit } = figures.error;
  if (value === null) return texts.numbers.errorUnknown;
  const of = limit === null ? "" : ` · ${texts.theatre.limit} ${formatNumber(limit, 2)} mm`;
  return `${texts.numbers.error} ±${formatNumber(value, 2)} mm${of}`;
}

/** How far the shown tip may lag behind one that moves, to be added to the error; empty at rest. */
export function lagText({ lag }: AssessmentMessage, texts: Texts): string {
  const speedMmS = lag?.speed_mm_s ?? 0;
  if (lag === null || speedMmS === 0) return "";
  if (lag.margin_mm === null || lag.latency_ms === null) return texts.numbers.latencyUnknown;
  const by = `${formatNumber(speedMmS, 0)} mm/s × ${formatNumber(lag.latency_ms, 0)} ms`;
  return `${texts.numbers.whileMoving} +${formatNumber(lag.margin_mm)} mm (${by})`;
}

/** Which wall is the nearest; that the drill is outside, where none is. */
export function wallSide({ wall, figures }: AssessmentMessage, texts: Texts): string {
  if (wall !== null) return texts.wall.side[wall];
  return figures.wall.status === "outside" ? texts.wall.outside : "";
}
