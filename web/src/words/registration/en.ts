export const registrationEn = { title: "Registration" };

export type RegistrationWords = typeof registrationEn;
