// The theme of the shown view, for the style sheets and for Mantine.
import { MantineProvider } from "@mantine/core";
import { createContext, use, useLayoutEffect, useState, useSyncExternalStore, type ReactNode } from "react";
import { useLocation } from "wouter";
import { useSession } from "../app/session";
import { viewAt } from "../app/views";
import { theme as mantineTheme } from "./theme";
import {
  otherTheme,
  placeOf,
  storedThemes,
  storeThemes,
  themeOf,
  type Place,
  type ThemeName,
} from "./themeChoice";

interface ThemeValue {
  theme: ThemeName;
  switchTheme: () => void;
}

const ThemeContext = createContext<ThemeValue | null>(null);
const PREFERS_LIGHT = "(prefers-color-scheme: light)";

export function ThemeProvider({ children }: { children: ReactNode }): ReactNode {
  const [choices, setChoices] = useState(storedThemes);
  const prefersLight = useSyncExternalStore(onPreference, () => matchMedia(PREFERS_LIGHT).matches);
  const place = usePlace();
  const theme = themeOf(choices, place, prefersLight);
  // Before the first paint, so that no page flashes in the other theme.
  useLayoutEffect(() => {
    document.documentElement.dataset["theme"] = theme;
  }, [theme]);
  const switchTheme = (): void => {
    const next = { ...choices, [place]: otherTheme(theme) };
    storeThemes(next);
    setChoices(next);
  };
  return (
    <ThemeContext value={{ theme, switchTheme }}>
      <MantineProvider theme={mantineTheme} forceColorScheme={theme}>
        {children}
      </MantineProvider>
    </ThemeContext>
  );
}

export function useTheme(): ThemeValue {
  const value = use(ThemeContext);
  if (value === null) throw new Error("useTheme must be used inside ThemeProvider");
  return value;
}

/** The place of the shown view; before the session is known, of the view in the address. */
function usePlace(): Place {
  const [path] = useLocation();
  const { session } = useSession();
  if (path === "/enter" || path === "/camera") return "pages";
  return placeOf(viewAt(path, session.state === "in" ? session.who.role : "operator"));
}

function onPreference(onChange: () => void): () => void {
  const query = matchMedia(PREFERS_LIGHT);
  query.addEventListener("change", onChange);
  return () => {
    query.removeEventListener("change", onChange);
  };
}
