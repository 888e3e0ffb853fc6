export const supervisorEn = { title: "Supervisor" };

export type SupervisorWords = typeof supervisorEn;
