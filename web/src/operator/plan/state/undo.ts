// Undo: the version of the plan before each change on this page.
//
// Undo stores the older content as a new version. It is offered only while the newest version is the last one made
// here, so that nobody else's change is undone unseen.

export interface Step {
  /** Document before the change; null if there was no plan. */
  documentId: string | null;
  /** Version made by the change. */
  madeVersion: number;
}

const MAX_STEPS = 30;

export function withChange(steps: readonly Step[], documentId: string | null, madeVersion: number): Step[] {
  return [...steps, { documentId, madeVersion }].slice(-MAX_STEPS);
}

/** What can be undone while this version is the newest; null if nothing. */
export function lastStep(steps: readonly Step[], newestVersion: number): Step | null {
  const last = steps.at(-1);
  return last?.madeVersion === newestVersion ? last : null;
}

/** After undo made this version: the previous change becomes the next to undo. */
export function withoutLast(steps: readonly Step[], madeVersion: number): Step[] {
  const left = steps.slice(0, -1);
  const last = left.at(-1);
  return last === undefined ? [] : [...left.slice(0, -1), { ...last, madeVersion }];
}

export function read(text: string | null): Step[] {
  try {
    const steps = JSON.parse(text ?? "[]") as unknown;
    return Array.isArray(steps) ? (steps as Step[]) : [];
  } catch {
    return [];
  }
}
