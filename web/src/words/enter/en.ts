export const enterEn = {
  needed: "Sign in with the link that the server printed at its start, or with an invitation.",
};

export type EnterWords = typeof enterEn;
