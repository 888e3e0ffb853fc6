// At the hub, a document shows the list of theatres, or the one theatre of its address. Another theatre is another
// document, so that nothing of one can appear under the name of the other.

/** The theatre of an address `/theatres/NAME`; null for any other address. */
export function theatreAt(path: string): string | null {
  const [, view, name, ...rest] = path.split("/");
  return view === "theatres" && name !== undefined && name !== "" && rest.length === 0
    ? decodeURIComponent(name)
    : null;
}

export const OPENED = theatreAt(location.pathname);
const PREFIX = OPENED === null ? "" : `/at/${encodeURIComponent(OPENED)}`;

/** A theatre's address as this document reaches it: through the hub, where one is opened there. */
export function throughHub(path: string): string {
  return PREFIX + path;
}

/** For requests to the server of this document itself, also where it shows a theatre through the hub. */
export const OWN_SERVER = { baseUrl: location.origin };
