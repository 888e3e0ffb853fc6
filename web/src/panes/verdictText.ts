// What stands beside the headline, from the figures. Pure, so that it is tested without a page.
import type { AssessmentMessage, Tone } from "../live/messages";
import { shownNumber } from "../live/rounding";
import type { Words } from "../words/en";

/** A shape of its own for each, as in the video: the colour says nothing that the shape does not. */
export const TONE_SYMBOL: Record<Tone, string> = {
  good: "●",
  caution: "▲",
  warning: "◆",
  danger: "✖",
  none: "○",
};

/** The probability of a breach, within 2 mm and by the screw at the end, with the limit of both. */
export function riskText({ figures }: AssessmentMessage, words: Words): string {
  const { risk, end } = figures;
  const parts = [
    risk.value === null ? "" : `${words.wall.soon} ${shownNumber(risk.value, 0)} %`,
    end.value === null ? "" : `${words.wall.atEnd} ${shownNumber(end.value, 0)} %`,
  ].filter((part) => part !== "");
  if (parts.length === 0) return "";
  return `${words.wall.risk}: ${parts.join(", ")} · ${words.theatre.limit} ${shownNumber(risk.limit, 0)} %`;
}

/** The error of the whole chain, marker, registration and tool, and what the pedicle leaves. */
export function errorText({ figures }: AssessmentMessage, words: Words): string {
  const { value, limit } = figures.error;
  if (value === null) return words.numbers.errorUnknown;
  const of = limit === null ? "" : ` · ${words.theatre.limit} ${shownNumber(limit, 2)} mm`;
  return `${words.numbers.error} ±${shownNumber(value, 2)} mm${of}`;
}

/** Which wall is the nearest; that the drill is outside, where none is. */
export function wallSide({ wall, figures }: AssessmentMessage, words: Words): string {
  if (wall !== null) return words.wall.side[wall];
  return figures.wall.status === "outside" ? words.wall.outside : "";
}
