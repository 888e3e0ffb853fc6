// A text that the server sends in every language.
import type { LiveProblemMessage, TextMessage } from "../live/messages";
import type { Texts } from "./en";

export function textOf(text: TextMessage, texts: Texts): string {
  return texts.language === "de" ? text.de : text.en;
}

/** The language of a problem's texts, for `lang`: without a translation they are English for every language. */
export function languageOf(problem: LiveProblemMessage, texts: Texts): Texts["language"] {
  return problem.is_translated ? texts.language : "en";
}

/** Such a text in an untyped line of a log; empty if there is none. */
export function textIn(line: Readonly<Record<string, unknown>>, key: string, texts: Texts): string {
  const textByLanguage = line[key];
  if (typeof textByLanguage !== "object" || textByLanguage === null) return "";
  const text = (textByLanguage as Record<string, unknown>)[texts.language];
  return typeof text === "string" ? text : "";
}
