// What the calibration says of the readout, in one sentence.
import { shownNumber } from "../../live/rounding";
import type { components } from "../../schema";
import { filled } from "../../words/filled";
import type { ReadoutWords } from "../../words/camera/readout";

export function readoutText(readout: components["schemas"]["ReadoutMessage"], words: ReadoutWords): string {
  const { readout_ms: ms, found_by: by } = readout;
  if (ms === null || by === null) return words.notKnown;
  return ms === 0 ? words.global[by] : filled(words.rolling[by], { ms: shownNumber(ms) });
}
