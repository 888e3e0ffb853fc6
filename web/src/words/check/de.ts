import type { CheckWords } from "./en";

export const checkDe: CheckWords = { title: "Prüfung an einem Punkt" };
