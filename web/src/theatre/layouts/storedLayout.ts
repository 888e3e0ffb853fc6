// Layout, its keys and whether it follows the drill, stored in this browser.
import { isLayout, type Layout } from "./layout";
import { isAssignable, KEY_ACTIONS, type Keys } from "./keys";

export interface LayoutChoice {
  layout: Layout;
  /** Whether the layout follows the drill. */
  isAutomatic: boolean;
  keys: Keys;
}

export const FIRST_LAYOUT: LayoutChoice = { layout: "overview", isAutomatic: false, keys: {} };
const STORAGE_KEY = "coaxial.theatre-layout";

export function storedLayout(): LayoutChoice {
  try {
    return readLayout(localStorage.getItem(STORAGE_KEY));
  } catch {
    // Storage is unavailable: same as on the first visit.
    return FIRST_LAYOUT;
  }
}

export function storeLayout(choice: LayoutChoice): void {
  try {
    localStorage.setItem(STORAGE_KEY, JSON.stringify(choice));
  } catch {
    // The choice then applies to this visit only.
  }
}

/** Reads what was stored, and ignores parts that another version stored differently. */
export function readLayout(stored: string | null): LayoutChoice {
  if (stored === null) return FIRST_LAYOUT;
  let value: unknown;
  try {
    value = JSON.parse(stored);
  } catch {
    return FIRST_LAYOUT;
  }
  const { layout, isAutomatic, keys } = recordOf(value);
  return {
    layout: isLayout(layout) ? layout : FIRST_LAYOUT.layout,
    isAutomatic: isAutomatic === true,
    keys: readKeys(keys),
  };
}

function readKeys(value: unknown): Keys {
  const stored = recordOf(value);
  const keys: Keys = {};
  for (const action of KEY_ACTIONS) {
    const code = stored[action];
    if (typeof code === "string" && isAssignable({ ...NO_MODIFIER, code })) keys[action] = code;
  }
  return keys;
}

const NO_MODIFIER = { repeat: false, altKey: false, ctrlKey: false, metaKey: false };

function recordOf(value: unknown): Record<string, unknown> {
  return typeof value === "object" && value !== null ? { ...value } : {};
}
