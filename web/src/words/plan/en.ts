export const planEn = { title: "Plan" };

export type PlanWords = typeof planEn;
