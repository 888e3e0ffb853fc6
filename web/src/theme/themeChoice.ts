// Which theme the pages of this browser have: what was chosen; else theatre screens, which are read from afar beside dark
// pictures, are dark, and other pages as the browser prefers. Pure but for the storage.
// `public/theme.js` applies the same rule before the first paint.

export type ThemeName = "dark" | "light";

export function themeOf(chosen: ThemeName | null, prefersLight: boolean, path: string): ThemeName {
  return chosen ?? (prefersLight && !path.startsWith("/theatre") ? "light" : "dark");
}

export function otherTheme(theme: ThemeName): ThemeName {
  return theme === "dark" ? "light" : "dark";
}

const STORAGE_KEY = "coaxial.theme";

export function storedTheme(): ThemeName | null {
  try {
    return readTheme(localStorage.getItem(STORAGE_KEY));
  } catch {
    // Storage is unavailable: same as on the first visit.
    return null;
  }
}

export function storeTheme(theme: ThemeName): void {
  try {
    localStorage.setItem(STORAGE_KEY, theme);
  } catch {
    // The choice then applies to this visit only.
  }
}

/** Reads what was stored, and ignores what is no theme. */
export function readTheme(stored: string | null): ThemeName | null {
  return stored === "dark" || stored === "light" ? stored : null;
}
