// The way back: which version of the plan stood before each change that was made on this page.
//
// A step back stores the older content as a new version. It is offered only while the newest version is the one
// that the last change here made: what somebody else did since is never taken back unseen.

export interface Step {
  /** The document that held before the change; null where there was no plan. */
  documentId: string | null;
  /** The version that the change made. */
  madeVersion: number;
}

const MAX_STEPS = 30;

export function withChange(steps: readonly Step[], documentId: string | null, madeVersion: number): Step[] {
  return [...steps, { documentId, madeVersion }].slice(-MAX_STEPS);
}

/** What can be taken back while this version is the newest; null where nothing can. */
export function lastStep(steps: readonly Step[], newestVersion: number): Step | null {
  const last = steps.at(-1);
  return last?.madeVersion === newestVersion ? last : null;
}

/** After a step back made this version: the change before can be taken back next. */
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
