// Which server state may be shown: nothing that was received before the connection was lost.
import { isOfNow } from "../live/assess";
import type { LinkState } from "../live/viewConnection";
import type { View } from "../live/live";
import type { LiveMessage } from "../live/messages";

interface ServerState {
  linkState: LinkState | "not-reached";
  source: LiveMessage["source"] | null;
  snapshot: LiveMessage["snapshot"];
  /** Whether the newest image is young enough. Good states are shown as good only then. */
  isOfNow: boolean;
}

export function serverStateOf({ link, firstMessage, video, numbers, newest }: View): ServerState {
  if (firstMessage !== "received") {
    const linkState = firstMessage === "awaited" ? "connecting" : "not-reached";
    return { linkState, source: null, snapshot: null, isOfNow: false };
  }
  const gone = link === "open" && !video.live && video.cause === "server-gone";
  const linkState = gone ? "lost" : link;
  const isConnected = linkState === "open";
  return {
    linkState,
    source: isConnected ? (newest?.source ?? null) : null,
    snapshot: isConnected ? (newest?.snapshot ?? null) : null,
    isOfNow: isConnected && isOfNow(numbers),
  };
}
