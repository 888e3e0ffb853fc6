import type { Problem } from "../../rest/client";

/** What a rejection's body says; the page has its own words for one that says nothing. */
export function problemIn(text: string, status: number): Problem {
  const body = parsed(text);
  if (typeof body === "object" && body !== null && "code" in body && "message" in body)
    return body as Problem;
  return { code: "NO_ANSWER", message: "", remedy: "", context: { status } };
}

/** What a text says as JSON; null where it is none. */
export function parsed(text: string): unknown {
  try {
    return JSON.parse(text) as unknown;
  } catch {
    return null;
  }
}
