import type { NavigateWords } from "./en";

export const navigateDe: NavigateWords = { title: "Navigation im Kanal" };
