import type { CameraNoteMessage, ProblemMessage } from "../live/messages";
import type { View } from "../live/live";

/** What the server says is wrong now: tracking first, then the camera. Nothing while the server is gone. */
export function problemsOf({ newest }: View): ProblemMessage[] {
  if (newest === null) return [];
  return [newest.process.problem, newest.source.problem]
    .filter((problem) => problem !== null)
    .map((problem) => ({ ...problem, message: capitalised(problem.message) }));
}

/** What is worth mending about the camera and stops nothing; null while nothing is. */
export function noteOf({ newest }: View): CameraNoteMessage | null {
  return newest?.source.camera?.note ?? null;
}

/** The server's messages begin small and have no full stop, so that they stand in a sentence as well. */
function capitalised(message: string): string {
  return message.charAt(0).toUpperCase() + message.slice(1);
}
