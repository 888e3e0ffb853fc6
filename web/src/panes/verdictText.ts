// Texts beside the headline, computed from the figures. Pure.
import type { AssessmentMessage, Tone } from "../live/messages";
import { formatNumber } from "../live/rounding";
import type { Texts } from "../texts/en";

/** A symbol for each tone, as in the video: colour never carries information alone. */
export const TONE_SYMBOL: Record<Tone, string> = {
  good: "●",
  caution: "▲",
  warning: "◆",
  danger: "✖",
  none: "○",
};

/** Probability of a breach within 2 mm and by the screw at its end, with their limit. */
export function riskText({ figures }: AssessmentMessage, texts: Texts): string {
  const { risk, end } = figures;
  const parts = [
    risk.value === null ? "" : `${texts.wall.soon} ${formatNumber(risk.value, 0)} %`,
    end.value === null ? "" : `${texts.wall.atEnd} ${formatNumber(end.value, 0)} %`,
  ].filter((part) => part !== "");
  if (parts.length === 0) return "";
  return `${texts.wall.risk}: ${parts.join(", ")} · ${texts.theatre.limit} ${formatNumber(risk.limit, 0)} %`;
}

/** Error of the whole chain (marker, registration, tool), and what the pedicle tolerates. */
export function errorText({ figures }: AssessmentMessage, texts: Texts): string {
  const { value, limit } = figures.error;
  if (value === null) return texts.numbers.errorUnknown;
  const of = limit === null ? "" : ` · ${texts.theatre.limit} ${formatNumber(limit, 2)} mm`;
  return `${texts.numbers.error} ±${formatNumber(value, 2)} mm${of}`;
}

/** How far a moving tip may lag behind, in addition to the error; empty at rest. */
export function lagText({ lag }: AssessmentMessage, source: string, texts: Texts): string {
  const speedMmS = lag?.speed_mm_s ?? 0;
  if (lag === null || speedMmS === 0) return "";
  if (lag.margin_mm === null || lag.latency_ms === null) {
    const { measure, simulated } = texts.numbers.latencyUnknown;
    return source === "rehearsal" ? simulated : measure;
  }
  const by = `${formatNumber(speedMmS, 0)} mm/s × ${formatNumber(lag.latency_ms, 0)} ms`;
  return `${texts.numbers.whileMoving} +${formatNumber(lag.margin_mm)} mm (${by})`;
}

/** The nearest wall; outside the pedicle, that the drill is outside. */
export function wallSide({ wall, figures }: AssessmentMessage, texts: Texts): string {
  if (wall !== null) return texts.wall.side[wall];
  return figures.wall.status === "outside" ? texts.wall.outside : "";
}
