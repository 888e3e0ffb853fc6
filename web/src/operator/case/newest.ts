// Newest version of each document, last made first.
interface Versioned {
  kind: string;
  name: string;
  version: number;
}

interface Storable extends Versioned {
  withdrawn: object | null;
  is_damaged: boolean;
}

export function newestOf<Document extends Versioned>(documents: readonly Document[]): Document[] {
  const newest = new Map<string, Document>();
  for (const one of documents) {
    const key = `${one.kind} ${one.name}`;
    const before = newest.get(key);
    if (before !== undefined && before.version > one.version) continue;
    newest.delete(key);
    newest.set(key, one);
  }
  return [...newest.values()].reverse();
}

/** The version with which somebody can go on if this one, the newest, is damaged; null if there is none. */
export function lastIntact<Document extends Storable>(
  documents: readonly Document[],
  damaged: Document,
): Document | null {
  const named = documents.filter((one) => one.kind === damaged.kind && one.name === damaged.name);
  if (!damaged.is_damaged || named.some((one) => one.version > damaged.version)) return null;
  const intact = named.filter((one) => !one.is_damaged);
  const last = intact.reduce<Document | null>(
    (newest, one) => (newest !== null && newest.version > one.version ? newest : one),
    null,
  );
  return last?.withdrawn === null ? last : null;
}
