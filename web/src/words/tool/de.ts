import type { ToolWords } from "./en";

export const toolDe: ToolWords = { title: "Instrument" };
