export const restEn = {
  noAnswer: "The server does not answer.",
  noAnswerRemedy:
    "The request may not have been executed. Check the connection to the server, then try again.",
  loading: "Loading …",
  again: "Try again",
  goTo: "Go to {page}",
  waiting: "waiting",
  cancel: "Cancel",
  cancelled: "Cancelled. Nothing was saved.",
};

export type RestTexts = typeof restEn;
