export const helpEn = {
  open: "Help for this page, in the user guide",
};

export type HelpTexts = typeof helpEn;
