export const theatreEn = { title: "Theatre" };

export type TheatreWords = typeof theatreEn;
