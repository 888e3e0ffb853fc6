// The token of an invitation: the fragment of the link, which browsers do not send to a server.

const SHAPE = /^[0-9a-f]{12}\.[A-Za-z0-9_-]{43}$/;

/** Extracts the token from a complete link or from a bare token; null if there is none. */
export function tokenIn(text: string): string | null {
  const trimmed = text.trim();
  const token = trimmed.includes("#") ? trimmed.slice(trimmed.indexOf("#") + 1) : trimmed;
  return SHAPE.test(token) ? token : null;
}

/** Reads the token from the page's address and removes it from the history. */
export function takeToken(): string | null {
  const { hash, pathname, search } = location;
  if (hash.length < 2) return null;
  history.replaceState(history.state, "", pathname + search);
  return hash.slice(1);
}
