import type { RegistrationWords } from "./en";

export const registrationDe: RegistrationWords = { title: "Registrierung" };
