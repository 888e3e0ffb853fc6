export const restEn = {
  noAnswer: "The server does not answer.",
  noAnswerRemedy: "Nothing was done. Look at the line to the server, then try again.",
  loading: "Loading …",
  again: "Try again",
  waiting: "waiting",
  cancel: "Cancel",
  cancelled: "Cancelled. Nothing was kept of it.",
};

export type RestTexts = typeof restEn;
