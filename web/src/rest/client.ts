// Typed client of the server's API. A rejection keeps the server's message, context and remedy.
import createClient from "openapi-fetch";
import type { components, paths } from "../schema";
import { pageLanguage } from "../texts/pageLanguage";

export type Problem = components["schemas"]["ProblemMessage"];

export const server = createClient<paths>({ baseUrl: location.origin, cache: "no-store" });

const gone = new EventTarget();
const GONE = "session-gone";

server.use({
  onRequest({ request }) {
    request.headers.set("Accept-Language", pageLanguage());
  },
  onResponse({ response }) {
    if (response.status === 401) gone.dispatchEvent(new Event(GONE));
  },
});

/** Called when the server answers that the session is missing or has ended; its answer ends the session. */
export function onSessionGone(listener: () => void): () => void {
  gone.addEventListener(GONE, listener);
  return () => {
    gone.removeEventListener(GONE, listener);
  };
}

/** The server rejected the request or did not answer (`NO_ANSWER`). */
export class Rejection extends Error {
  constructor(readonly problem: Problem) {
    super(problem.message);
  }

  get isSessionGone(): boolean {
    return this.problem.code === "SESSION_NEEDED" || this.problem.code === "SESSION_EXPIRED";
  }
}

export const NO_ANSWER: Problem = {
  code: "NO_ANSWER",
  message: "",
  remedy: "",
  context: {},
  language: "en",
};

interface Answer<Data> {
  data?: Data;
  error?: unknown;
  response: Response;
}

/**
 * Returns the body of an answer: `await answered(server.GET("/api/cases"))`.
 *
 * @throws Rejection
 */
export async function answered<Data>(request: Promise<Answer<Data>>): Promise<Data> {
  return (await answeredWithResponse(request)).data;
}

/**
 * Returns the body with the response, for its status and headers.
 *
 * @throws Rejection
 */
export async function answeredWithResponse<Data>(
  request: Promise<Answer<Data>>,
): Promise<{ data: Data; response: Response }> {
  let answer: Answer<Data>;
  try {
    answer = await request;
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw new Rejection(NO_ANSWER);
  }
  if (!answer.response.ok) throw new Rejection(problemOf(answer.error, answer.response));
  return { data: answer.data as Data, response: answer.response };
}

function problemOf(error: unknown, response: Response): Problem {
  if (typeof error === "object" && error !== null && "code" in error && "message" in error) {
    return error as Problem;
  }
  return { ...NO_ANSWER, context: { status: response.status } };
}
