export const shellEn = {
  views: "Views",
  view: { theatre: "Theatre", operator: "Operator", supervisor: "Supervisor" },
  status: "State of the system",
  tracking: "Tracking",
  live: "numbers live",
  none: "no numbers",
  theme: { light: "Light colours", dark: "Dark colours" },
};

export type ShellTexts = typeof shellEn;
