// Asks the server, with the types of its schema; a refusal keeps its sentence, its numbers and its remedy.
import createClient from "openapi-fetch";
import type { components, paths } from "../schema";

export type Trouble = components["schemas"]["TroubleMessage"];

// Tests of pure parts run without a browser.
const baseUrl = typeof location === "undefined" ? "" : location.origin;

export const server = createClient<paths>({ baseUrl, cache: "no-store" });

const gone = new EventTarget();
const GONE = "session-gone";

server.use({
  onResponse({ response }) {
    if (response.status === 401) gone.dispatchEvent(new Event(GONE));
  },
});

/** Called when the server says that nobody is signed in here, or no longer; the answer ends that. */
export function onSessionGone(listener: () => void): () => void {
  gone.addEventListener(GONE, listener);
  return () => {
    gone.removeEventListener(GONE, listener);
  };
}

/** The server said no, or did not answer (`NO_ANSWER`). */
export class Refusal extends Error {
  constructor(readonly trouble: Trouble) {
    super(trouble.message);
  }

  get isSessionGone(): boolean {
    return this.trouble.code === "SESSION_NEEDED" || this.trouble.code === "SESSION_EXPIRED";
  }
}

const NO_ANSWER: Trouble = { code: "NO_ANSWER", message: "", remedy: "", context: {} };

interface Answer<Data> {
  data?: Data;
  error?: unknown;
  response: Response;
}

/**
 * What the server answers: `await answered(server.GET("/api/cases"))`.
 *
 * @throws Refusal
 */
export async function answered<Data>(asked: Promise<Answer<Data>>): Promise<Data> {
  let answer: Answer<Data>;
  try {
    answer = await asked;
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw new Refusal(NO_ANSWER);
  }
  if (!answer.response.ok) throw new Refusal(troubleOf(answer.error, answer.response));
  return answer.data as Data;
}

function troubleOf(error: unknown, response: Response): Trouble {
  if (typeof error === "object" && error !== null && "code" in error && "message" in error) {
    return error as Trouble;
  }
  return { ...NO_ANSWER, context: { status: response.status } };
}
