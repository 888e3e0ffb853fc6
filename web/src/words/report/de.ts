import type { ReportWords } from "./en";

export const reportDe: ReportWords = { title: "Bericht" };
