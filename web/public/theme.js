// Runs before the first paint, so that no page flashes in the other theme: the rule of `themeOf` in src/theme/themeChoice.ts.
{
  let chosen = null;
  try {
    chosen = localStorage.getItem("coaxial.theme");
  } catch {
    // Storage is unavailable: same as on the first visit.
  }
  const prefersLight = matchMedia("(prefers-color-scheme: light)").matches;
  const preferred = prefersLight && !location.pathname.startsWith("/theatre") ? "light" : "dark";
  const theme = chosen === "light" || chosen === "dark" ? chosen : preferred;
  document.documentElement.dataset.theme = theme;
  document.documentElement.dataset.mantineColorScheme = theme;
}
