// What an accuracy test asks for next, in one sentence.
import type { AccuracyTestMessage } from "../../api";
import { formatNumber } from "../../live/rounding";
import type { CertificateTexts } from "../../texts/certificate/en";
import { interpolate } from "../../texts/interpolate";

type Texts = CertificateTexts["guided"];

/** The active capture comes first; a complete test states its result. */
export function accuracyText(state: AccuracyTestMessage, texts: Texts): string {
  const { capture, due, error_95_mm, problems } = state;
  if (capture?.state === "looking") {
    const { divot, seen, images } = capture;
    return interpolate(texts.looking, { divot, seen, images });
  }
  if (due !== null) {
    const holds: Partial<Record<string, string>> = texts.hold;
    return interpolate(holds[due.posture] ?? texts.other, { ...due });
  }
  // Without a figure nothing is promised.
  if (problems.length > 0 || error_95_mm === null) return texts.rejected;
  return interpolate(texts.complete, { mm: formatNumber(error_95_mm, 2) });
}

/** Where the plate belongs, as long as nothing was captured there; null afterwards. */
export function placementText({ due, divots }: AccuracyTestMessage, texts: Texts): string | null {
  if (due === null || divots.some((one) => one.taken > 0)) return null;
  const places: Partial<Record<string, string>> = texts.place;
  return places[due.placement] ?? null;
}
