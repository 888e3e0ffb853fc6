// A text that the server has written in every language.
import type { TextMessage } from "../live/messages";
import type { Words } from "./en";

export function textOf(text: TextMessage, words: Words): string {
  return words.language === "de" ? text.de : text.en;
}

/** Such a text of a line whose form is not known, as of the log; empty where there is none. */
export function inWords(line: Readonly<Record<string, unknown>>, key: string, words: Words): string {
  const texts = line[key];
  if (typeof texts !== "object" || texts === null) return "";
  const text = (texts as Record<string, unknown>)[words.language];
  return typeof text === "string" ? text : "";
}
