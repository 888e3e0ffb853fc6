// What may still be said of the server: nothing that it told before it went.
import { isOfNow } from "../live/assess";
import type { LinkState } from "../live/line";
import type { View } from "../live/live";
import type { LiveMessage } from "../live/messages";

export interface HeardOf {
  linkState: LinkState | "not-reached";
  source: LiveMessage["source"] | null;
  snapshot: LiveMessage["snapshot"];
  /** The newest image is young enough for its figures: what is well is shown as well only then. */
  isOfNow: boolean;
}

export function heardOf({ link, firstMessage, video, numbers, newest }: View): HeardOf {
  if (firstMessage !== "received") {
    const linkState = firstMessage === "awaited" ? "connecting" : "not-reached";
    return { linkState, source: null, snapshot: null, isOfNow: false };
  }
  const gone = link === "open" && !video.live && video.cause === "server-gone";
  const linkState = gone ? "lost" : link;
  const isHeard = linkState === "open";
  return {
    linkState,
    source: isHeard ? (newest?.source ?? null) : null,
    snapshot: isHeard ? (newest?.snapshot ?? null) : null,
    isOfNow: isHeard && isOfNow(numbers),
  };
}
