import type { ReactNode } from "react";
import { Icon } from "../panes/Icon";
import { useTexts } from "../texts/TextsContext";
import { otherTheme } from "./themeChoice";
import { useTheme } from "./ThemeContext";

/** Switches between the dark and the light theme by one touch. */
export function ThemeButton(): ReactNode {
  const texts = useTexts().shell.theme;
  const { theme, switchTheme } = useTheme();
  const label = texts[otherTheme(theme)];
  return (
    <button
      type="button"
      className="theme-button"
      data-testid="theme"
      aria-label={label}
      title={label}
      onClick={switchTheme}
    >
      <Icon name={theme === "dark" ? "sun" : "moon"} />
    </button>
  );
}
