import type { PlanWords } from "./en";

export const planDe: PlanWords = { title: "Planung" };
