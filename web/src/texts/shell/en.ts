export const shellEn = {
  views: "Views",
  view: { theatre: "Theatre", operator: "Operator", supervisor: "Supervisor" },
  status: "State of the system",
  tracking: "Tracking",
  live: "numbers live",
  none: "no numbers",
};

export type ShellTexts = typeof shellEn;
