export const caseEn = { title: "Cases" };

export type CaseWords = typeof caseEn;
