// The readout of a calibration as a sentence.
import { formatNumber } from "../../live/rounding";
import type { ReadoutMessage } from "../../api";
import { interpolate } from "../../texts/interpolate";
import type { ReadoutTexts } from "../../texts/camera/readout";

export function readoutText(readout: ReadoutMessage, texts: ReadoutTexts): string {
  const { readout_ms: ms, found_by: by } = readout;
  if (ms === null || by === null) return texts.notKnown;
  return ms === 0 ? texts.global[by] : interpolate(texts.rolling[by], { ms: formatNumber(ms) });
}
