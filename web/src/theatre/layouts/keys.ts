// Keys that change the layout: a foot switch is a keyboard to the browser. Pure. No key does anything before it is set
// here, because a dropped instrument presses keys.
import { LAYOUTS, nextLayout, type Layout } from "./layout";

export const KEY_ACTIONS = [...LAYOUTS, "next"] as const;
export type KeyAction = (typeof KEY_ACTIONS)[number];
/** By action, the `code` of its key. */
export type Keys = Partial<Record<KeyAction, string>>;

export interface PressedKey {
  code: string;
  repeat: boolean;
  altKey: boolean;
  ctrlKey: boolean;
  metaKey: boolean;
}

/** Keys by which the page is used without a mouse, or which belong to others. */
const RESERVED: ReadonlySet<string> = new Set([
  "",
  "Tab",
  "Escape",
  "Enter",
  "NumpadEnter",
  "Space",
  "Unidentified",
  ...["Shift", "Control", "Alt", "Meta"].flatMap((name) => [`${name}Left`, `${name}Right`]),
]);

/** Whether a key may change the layout. */
export function isAssignable({ code, altKey, ctrlKey, metaKey }: PressedKey): boolean {
  return !RESERVED.has(code) && !altKey && !ctrlKey && !metaKey;
}

/** The keys with this one set; a key has one action. */
export function withKey(keys: Keys, action: KeyAction, code: string): Keys {
  const others = Object.fromEntries(Object.entries(keys).filter(([, one]) => one !== code));
  return { ...others, [action]: code };
}

export function withoutKey(keys: Keys, action: KeyAction): Keys {
  return Object.fromEntries(Object.entries(keys).filter(([one]) => one !== action));
}

/** The layout that a key chooses; null if it chooses none, as while it is held down. */
export function layoutByKey(pressed: PressedKey, keys: Keys, shown: Layout): Layout | null {
  if (pressed.repeat || !isAssignable(pressed)) return null;
  const action = KEY_ACTIONS.find((one) => keys[one] === pressed.code);
  if (action === undefined) return null;
  return action === "next" ? nextLayout(shown) : action;
}
