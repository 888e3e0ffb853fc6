import type { SupervisorWords } from "./en";

export const supervisorDe: SupervisorWords = { title: "Aufsicht" };
