// The theme of all pages, for the style sheets and for Mantine.
import { MantineProvider } from "@mantine/core";
import { useLocation } from "wouter";
import { createContext, use, useLayoutEffect, useState, useSyncExternalStore, type ReactNode } from "react";
import { theme as mantineTheme } from "./theme";
import { otherTheme, storedTheme, storeTheme, themeOf, type ThemeName } from "./themeChoice";

interface ThemeValue {
  theme: ThemeName;
  switchTheme: () => void;
}

const ThemeContext = createContext<ThemeValue | null>(null);
const PREFERS_LIGHT = "(prefers-color-scheme: light)";

export function ThemeProvider({ children }: { children: ReactNode }): ReactNode {
  const [path] = useLocation();
  const [chosen, setChosen] = useState(storedTheme);
  const prefersLight = useSyncExternalStore(onPreference, () => matchMedia(PREFERS_LIGHT).matches);
  const theme = themeOf(chosen, prefersLight, path);
  useLayoutEffect(() => {
    document.documentElement.dataset["theme"] = theme;
  }, [theme]);
  const switchTheme = (): void => {
    const next = otherTheme(theme);
    storeTheme(next);
    setChosen(next);
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

function onPreference(onChange: () => void): () => void {
  const query = matchMedia(PREFERS_LIGHT);
  query.addEventListener("change", onChange);
  return () => {
    query.removeEventListener("change", onChange);
  };
}
