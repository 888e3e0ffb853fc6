// Configures the generated client of the server's API (`src/api`). A rejection keeps the server's message, context and
// remedy. `main.tsx` imports this file, before anything is requested.
import type { ProblemMessage as Problem } from "../api";
import { client } from "../api/client.gen";
import { throughHub } from "../hub/openedTheatre";
import { pageLanguage } from "../texts/pageLanguage";

export type { Problem };

const gone = new EventTarget();
const GONE = "session-gone";

client.setConfig({ baseUrl: location.origin + throughHub(""), cache: "no-store" });
client.interceptors.request.use((request) => {
  request.headers.set("Accept-Language", pageLanguage());
  return request;
});
client.interceptors.response.use((response) => {
  if (response.status === 401) gone.dispatchEvent(new Event(GONE));
  return response;
});
client.interceptors.error.use(rejectionOf);

/** Called when the server answers that the session is missing or has ended; its answer ends the session. */
export function onSessionGone(listener: () => void): () => void {
  gone.addEventListener(GONE, listener);
  return () => {
    gone.removeEventListener(GONE, listener);
  };
}

/** The server rejected the request or did not answer (`NO_ANSWER`). Every function of `src/api` throws it. */
export class Rejection extends Error {
  /** `status` is that of the response; null without one. */
  constructor(
    readonly problem: Problem,
    readonly status: number | null = null,
  ) {
    super(problem.message);
  }
}

export const NO_ANSWER: Problem = {
  code: "NO_ANSWER",
  message: "",
  remedy: "",
  context: {},
  language: "en",
};

/** Returns what a request throws; an aborted one stays an `AbortError`. */
function rejectionOf(error: unknown, response: Response | undefined): unknown {
  if (error instanceof DOMException && error.name === "AbortError") return error;
  // An answer that cannot be read is none.
  if (response === undefined || response.ok) return new Rejection(NO_ANSWER);
  const { status } = response;
  return new Rejection(isProblem(error) ? error : { ...NO_ANSWER, context: { status } }, status);
}

function isProblem(error: unknown): error is Problem {
  return typeof error === "object" && error !== null && "code" in error && "message" in error;
}
