export const restEn = {
  noAnswer: "The server does not answer.",
  noAnswerRemedy: "Nothing was done. Look at the line to the server, then try again.",
  waiting: "waiting",
  cancel: "Cancel",
  cancelled: "Cancelled. Nothing was kept of it.",
};

export type RestWords = typeof restEn;
