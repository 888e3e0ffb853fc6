export const reportEn = { title: "Report" };

export type ReportWords = typeof reportEn;
