// Layouts of the theatre view: what is large in each phase of drilling. Pure.
import type { FigureName } from "../../panes/limits";

export const LAYOUTS = ["approach", "align", "drill", "overview"] as const;
export type Layout = (typeof LAYOUTS)[number];

/** Figures that are drawn larger; the others stay, since alarms and limits refer to them. */
export const LARGE_FIGURES: Record<Layout, readonly FigureName[]> = {
  approach: ["entry"],
  align: ["entry", "angle"],
  drill: ["depth", "wall"],
  overview: [],
};

/** The layout after this one, for a foot switch with one pedal. */
export function nextLayout(layout: Layout): Layout {
  return LAYOUTS[(LAYOUTS.indexOf(layout) + 1) % LAYOUTS.length] ?? "overview";
}

export function isLayout(name: unknown): name is Layout {
  return LAYOUTS.some((one) => one === name);
}

const PARAMETER = "layout";
const FIGURES_SCREEN = "figures";

/** Whether the address is that of the screen with figures only. */
export function isFiguresScreen(query: string): boolean {
  return new URLSearchParams(query).get(PARAMETER) === FIGURES_SCREEN;
}

/** Address of that screen, or of the other one, with the rest of the query as it is. */
export function screenAddress(query: string, screen: "figures" | "theatre"): string {
  const parameters = new URLSearchParams(query);
  if (screen === "figures") parameters.set(PARAMETER, FIGURES_SCREEN);
  else parameters.delete(PARAMETER);
  const rest = parameters.toString();
  return rest === "" ? "/theatre" : `/theatre?${rest}`;
}

/** The layout in the address, or null. */
export function layoutInAddress(query: string): Layout | null {
  const name = new URLSearchParams(query).get(PARAMETER);
  return isLayout(name) ? name : null;
}
