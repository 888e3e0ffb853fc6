// The channel that the server proposes with the displayed figures. Pure.
import type { NumbersVerdict } from "./assess";
import type { LiveMessage, ProposedChannelMessage } from "./messages";

/** Returns the proposal of the newest message; null while its figures are not displayed. */
export function proposedChannel({
  numbers,
  newest,
}: {
  numbers: NumbersVerdict;
  newest: LiveMessage | null;
}): ProposedChannelMessage | null {
  return numbers.live ? (newest?.proposed_channel ?? null) : null;
}
