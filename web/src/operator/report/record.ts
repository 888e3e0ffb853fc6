// The case's documents as the record that they are: everything that was made, in the order of making.
import type { components } from "../../schema";

export type Heading = components["schemas"]["HeadingMessage"];

/** One entry of the record; a plan is kept with every touch, and is shown as one entry from first to last. */
export interface Entry {
  first: Heading;
  last: Heading;
}

/** Alarms and the log have a place of their own. */
const ELSEWHERE: ReadonlySet<Heading["kind"]> = new Set<Heading["kind"]>(["alarm", "audit"]);

/** `documents` in the order of making. */
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
