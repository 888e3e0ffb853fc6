// Texts of the check of the planned screw: one sentence with its values, and each remedy with its result.
import type { SetupCheckMessage } from "../api";
import { formatNumber } from "../live/rounding";
import { interpolate } from "../texts/interpolate";
import type { SetupCheckTexts } from "../texts/setupCheck/en";

export type SetupCheck = SetupCheckMessage;
type Remedy = SetupCheck["remedies"][number];

export function setupSentence(check: SetupCheck, side: string, texts: SetupCheckTexts): string {
  const { found } = check;
  const sentence = interpolate(texts[check.basis], {
    vertebra: check.vertebra,
    side,
    diameter: formatNumber(check.diameter_mm, 1),
    place: found.isthmus_95_mm >= found.entry_95_mm ? texts.isthmus : texts.entry,
    error: formatNumber(found.error_95_mm, 2),
    tolerance: formatNumber(found.tolerance_mm, 2),
    sd: check.landmark_sd_mm === null ? "" : formatNumber(check.landmark_sd_mm, 1),
  });
  return `${sentence} ${found.suffices ? texts.suffices : texts.insufficient[check.basis]}`;
}

/** What is enough or cannot be predicted: anything else would not help on its own. */
export function helpfulRemedies(check: SetupCheck): Remedy[] {
  return check.remedies.filter((one) => one.expected?.suffices !== false);
}

export function remedyText(
  { kind, expected, landmarks, diameter_mm }: Remedy,
  texts: SetupCheckTexts,
): string {
  const text = texts.remedy[kind];
  if (expected === null) return `${text}.`;
  const figure = interpolate(text, {
    landmarks: landmarks === null ? "" : String(landmarks),
    diameter: diameter_mm === null ? "" : formatNumber(diameter_mm, 1),
    error: formatNumber(expected.error_95_mm, 2),
    tolerance: formatNumber(expected.tolerance_mm, 2),
  });
  return `${figure}, ${texts.enough}.`;
}
