// Which server state may be shown: nothing that was received before the connection was lost.
import { SILENT_AFTER_MS, isOfNow, isServerHeard } from "../live/assess";
import type { LinkState } from "../live/viewConnection";
import type { View } from "../live/live";
import type { LiveMessage } from "../live/messages";

interface ServerState {
  /** "late": connected, but without a message for too long. */
  linkState: LinkState | "late" | "not-reached";
  source: LiveMessage["source"] | null;
  snapshot: LiveMessage["snapshot"];
  /** Whether the newest image is young enough. Good states are shown as good only then. */
  isOfNow: boolean;
}

export function serverStateOf(view: View): ServerState {
  const { link, firstMessage, silentMs, numbers, newest } = view;
  if (firstMessage !== "received") {
    const linkState = firstMessage === "awaited" ? "connecting" : "not-reached";
    return { linkState, source: null, snapshot: null, isOfNow: false };
  }
  const isHeard = isServerHeard(view);
  const silent = silentMs > SILENT_AFTER_MS ? "late" : "connecting";
  return {
    linkState: link === "open" && !isHeard ? silent : link,
    source: isHeard ? (newest?.source ?? null) : null,
    snapshot: isHeard ? (newest?.snapshot ?? null) : null,
    isOfNow: isHeard && isOfNow(numbers),
  };
}
