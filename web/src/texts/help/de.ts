import type { HelpTexts } from "./en";

export const helpDe: HelpTexts = {
  open: "Hilfe zu dieser Seite, im Handbuch (englisch)",
};
