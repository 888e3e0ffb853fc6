// Which theme a page has: what was chosen in this browser, else its default. Pure but for the storage.
import type { ViewName } from "../app/views";

export type ThemeName = "dark" | "light";
/** The theatre's screens have a choice of their own: a bright ward says nothing about a dark theatre. */
export type Place = "theatre" | "pages";
export type ThemeChoices = Partial<Record<Place, ThemeName>>;

export function placeOf(view: ViewName | null): Place {
  return view === "theatre" ? "theatre" : "pages";
}

/** Theatre is dark unless chosen otherwise; other pages are as the browser prefers. */
export function themeOf(choices: ThemeChoices, place: Place, prefersLight: boolean): ThemeName {
  return choices[place] ?? (place === "pages" && prefersLight ? "light" : "dark");
}

export function otherTheme(theme: ThemeName): ThemeName {
  return theme === "dark" ? "light" : "dark";
}

const STORAGE_KEY = "coaxial.theme";

export function storedThemes(): ThemeChoices {
  try {
    return readThemes(localStorage.getItem(STORAGE_KEY));
  } catch {
    // Storage is unavailable: same as on the first visit.
    return {};
  }
}

export function storeThemes(choices: ThemeChoices): void {
  try {
    localStorage.setItem(STORAGE_KEY, JSON.stringify(choices));
  } catch {
    // The choice then applies to this visit only.
  }
}

/** Reads what was stored, and ignores what is no theme. */
export function readThemes(stored: string | null): ThemeChoices {
  let value: unknown;
  try {
    value = JSON.parse(stored ?? "null");
  } catch {
    return {};
  }
  const choices: ThemeChoices = {};
  if (typeof value !== "object" || value === null) return choices;
  for (const place of ["theatre", "pages"] as const) {
    const theme = (value as Record<string, unknown>)[place];
    if (theme === "dark" || theme === "light") choices[place] = theme;
  }
  return choices;
}
