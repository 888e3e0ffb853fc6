export const shellEn = {
  views: "Views",
  view: { theatre: "Theatre", operator: "Operator", supervisor: "Supervisor" },
};

export type ShellWords = typeof shellEn;
