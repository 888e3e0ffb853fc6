// Undo and redo: the version of the plan before each change on this page, and before each undo.
//
// Both store the other content as a new version. They are offered only while the newest version is the last one made
// here, so that nobody else's change is undone unseen.

export interface Step {
  /** Document before the change; null if there was no plan. */
  documentId: string | null;
  /** Version made by the change. */
  madeVersion: number;
}

export interface History {
  /** Changes that can be undone, the newest last. */
  done: readonly Step[];
  /** Undone changes that can be made again, the next one last. */
  undone: readonly Step[];
}

export const NO_HISTORY: History = { done: [], undone: [] };
const MAX_STEPS = 30;

/** After a change: nothing that was undone before it can be made again. */
export function withChange(history: History, documentId: string | null, madeVersion: number): History {
  return { done: [...history.done, { documentId, madeVersion }].slice(-MAX_STEPS), undone: [] };
}

/** What can be undone, or made again, while this version is the newest; null if nothing. */
export function lastStep(steps: readonly Step[], newestVersion: number): Step | null {
  const last = steps.at(-1);
  return last?.madeVersion === newestVersion ? last : null;
}

/** After undo of a document made this version: the previous change is next to undo, this one to redo. */
export function afterUndo(history: History, documentId: string | null, madeVersion: number): History {
  return {
    done: withoutLast(history.done, madeVersion),
    undone: [...history.undone, { documentId, madeVersion }],
  };
}

/** After redo replaced a document by this version: the reverse of `afterUndo`. */
export function afterRedo(history: History, documentId: string | null, madeVersion: number): History {
  return {
    done: [...history.done, { documentId, madeVersion }],
    undone: withoutLast(history.undone, madeVersion),
  };
}

function withoutLast(steps: readonly Step[], madeVersion: number): Step[] {
  const left = steps.slice(0, -1);
  const last = left.at(-1);
  return last === undefined ? [] : [...left.slice(0, -1), { ...last, madeVersion }];
}

export function read(text: string | null): History {
  try {
    const history = JSON.parse(text ?? "null") as Partial<History> | null;
    const { done, undone } = history ?? NO_HISTORY;
    return Array.isArray(done) && Array.isArray(undone) ? { done, undone } : NO_HISTORY;
  } catch {
    return NO_HISTORY;
  }
}

/** Meaning of a pressed key: Ctrl+Z, Ctrl+Shift+Z and Ctrl+Y, or with the command key; null for others. */
export function historyKey(
  event: Pick<KeyboardEvent, "key" | "ctrlKey" | "metaKey" | "shiftKey" | "altKey">,
): "undo" | "redo" | null {
  if (!(event.ctrlKey || event.metaKey) || event.altKey) return null;
  const key = event.key.toLowerCase();
  if (key === "z") return event.shiftKey ? "redo" : "undo";
  return key === "y" && !event.shiftKey ? "redo" : null;
}

const OWN_UNDO = "input:not([type='radio'], [type='checkbox'], [type='range']), textarea, [role='dialog']";

/** Whether a key belongs to what has the focus: a field with its own undo, or a dialog. */
export function isTyping(target: EventTarget | null): boolean {
  return target instanceof Element && target.closest(OWN_UNDO) !== null;
}
