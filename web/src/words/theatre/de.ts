import type { TheatreWords } from "./en";

export const theatreDe: TheatreWords = { title: "Operationssaal" };
