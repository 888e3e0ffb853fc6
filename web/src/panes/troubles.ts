import type { TroubleMessage } from "../live/messages";
import type { View } from "../live/live";

/** What the server says is wrong now: tracking first, then the camera. Nothing while the server is gone. */
export function troublesOf({ newest }: View): TroubleMessage[] {
  if (newest === null) return [];
  return [newest.process.trouble, newest.source.trouble].filter((trouble) => trouble !== null);
}
