import type { CameraNoteMessage, ProblemMessage } from "../live/messages";
import type { View } from "../live/live";

/** Current problems reported by the server: tracking first, then the camera. Empty while the server is lost. */
export function problemsOf({ newest }: View): ProblemMessage[] {
  if (newest === null) return [];
  return [newest.process.problem, newest.source.problem]
    .filter((problem) => problem !== null)
    .map((problem) => ({ ...problem, message: capitalised(problem.message) }));
}

/** A recommendation about the camera that blocks nothing; null if there is none. */
export function noteOf({ newest }: View): CameraNoteMessage | null {
  return newest?.source.camera?.note ?? null;
}

/** The server's messages start in lower case and have no full stop. */
function capitalised(message: string): string {
  return message.charAt(0).toUpperCase() + message.slice(1);
}
