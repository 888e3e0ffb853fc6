// Newest version of each document, last made first.
interface Versioned {
  kind: string;
  name: string;
  version: number;
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
