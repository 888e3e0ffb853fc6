export const checkEn = { title: "Check on a landmark" };

export type CheckWords = typeof checkEn;
