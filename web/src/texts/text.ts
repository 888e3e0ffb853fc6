// A text that the server sends in every language.
import type { TextMessage } from "../live/messages";
import type { Texts } from "./en";

export function textOf(text: TextMessage, texts: Texts): string {
  return texts.language === "de" ? text.de : text.en;
}

/** Its language, for `lang`: what has no translation is sent in English for every language. */
export function languageOf(text: TextMessage, texts: Texts): Texts["language"] {
  return text.de === text.en ? "en" : texts.language;
}

/** Such a text in an untyped line of a log; empty if there is none. */
export function textIn(line: Readonly<Record<string, unknown>>, key: string, texts: Texts): string {
  const textByLanguage = line[key];
  if (typeof textByLanguage !== "object" || textByLanguage === null) return "";
  const text = (textByLanguage as Record<string, unknown>)[texts.language];
  return typeof text === "string" ? text : "";
}
