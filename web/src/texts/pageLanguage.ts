/** The language that the page is set to; requests state it, so that the server's sentences are in it, too. */
export const pageLanguage = (): string =>
  typeof document === "undefined" ? "en" : document.documentElement.lang || "en";
