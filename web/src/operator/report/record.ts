// Documents of the case in the order they were made.
import type { HeadingMessage } from "../../api";

export type Heading = HeadingMessage;

/** One entry. Consecutive versions of a plan are merged, since each touch stores one. */
export interface Entry {
  first: Heading;
  last: Heading;
}

/** Alarms and log have their own sections. */
const ELSEWHERE: ReadonlySet<Heading["kind"]> = new Set<Heading["kind"]>(["alarm", "audit"]);

/** `documents` in the order they were made. */
export function recordOf(documents: readonly Heading[]): Entry[] {
  const entries: Entry[] = [];
  for (const one of documents) {
    if (ELSEWHERE.has(one.kind)) continue;
    const before = entries.at(-1);
    if (before !== undefined && isSameWork(before.last, one)) before.last = one;
    else entries.push({ first: one, last: one });
  }
  return entries;
}

function isSameWork(before: Heading, one: Heading): boolean {
  return (
    one.kind === "plan" &&
    before.kind === one.kind &&
    before.name === one.name &&
    before.made_by === one.made_by &&
    before.withdrawn === null
  );
}
