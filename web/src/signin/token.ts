// What opens the door: the part of a link after its #. Browsers send that part to nobody.

const SHAPE = /^[0-9a-f]{12}\.[A-Za-z0-9_-]{43}$/;

/** The token in a whole link, or one that was typed by itself; null where there is none. */
export function tokenIn(text: string): string | null {
  const trimmed = text.trim();
  const token = trimmed.includes("#") ? trimmed.slice(trimmed.indexOf("#") + 1) : trimmed;
  return SHAPE.test(token) ? token : null;
}

/** The token in this page's own address, which is taken out of it, so that it stays in no history. */
export function takeToken(): string | null {
  const { hash, pathname, search } = location;
  if (hash.length < 2) return null;
  history.replaceState(history.state, "", pathname + search);
  return hash.slice(1);
}
