import type { ShellTexts } from "./en";

export const shellDe: ShellTexts = {
  views: "Ansichten",
  view: { theatre: "Operationssaal", operator: "Bedienung", supervisor: "Aufsicht" },
  status: "Zustand des Systems",
  tracking: "Tracking",
  live: "Werte live",
  none: "keine Werte",
  theme: { light: "Helle Farben", dark: "Dunkle Farben" },
};
