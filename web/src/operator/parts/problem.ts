import { NO_ANSWER, type Problem } from "../../rest/client";

/** Problem of a rejection's body; null if it has none. */
export function problemIn(text: string, status: number): Problem {
  const body = parsed(text);
  if (typeof body === "object" && body !== null && "code" in body && "message" in body)
    return body as Problem;
  return { ...NO_ANSWER, context: { status } };
}

/** Parses JSON; null if invalid. */
export function parsed(text: string): unknown {
  try {
    return JSON.parse(text) as unknown;
  } catch {
    return null;
  }
}
