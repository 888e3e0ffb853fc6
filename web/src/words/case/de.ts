import type { CaseWords } from "./en";

export const caseDe: CaseWords = { title: "Fälle" };
