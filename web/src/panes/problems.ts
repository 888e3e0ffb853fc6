import type { CameraNoteMessage, LiveProblemMessage } from "../live/messages";
import type { View } from "../live/live";

/** Current problems reported by the server: tracking first, then the camera. Empty while the server is lost. */
export function problemsOf({ newest }: View): LiveProblemMessage[] {
  if (newest === null) return [];
  return [newest.process.problem, newest.source.problem].filter((problem) => problem !== null);
}

/** A recommendation about the camera that blocks nothing; null if there is none. */
export function noteOf({ newest }: View): CameraNoteMessage | null {
  return newest?.source.camera?.note ?? null;
}
