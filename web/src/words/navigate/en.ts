export const navigateEn = { title: "Navigation" };

export type NavigateWords = typeof navigateEn;
