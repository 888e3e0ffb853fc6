// Language of the page: `?lang=`, else the browser's, else English.
import { de } from "./de";
import { en, type Texts } from "./en";

const BY_LANGUAGE = new Map<string, Texts>([en, de].map((texts) => [texts.language, texts]));

export function textsFor(query: string, browserLanguages: readonly string[]): Texts {
  const wanted = [new URLSearchParams(query).get("lang") ?? "", ...browserLanguages];
  for (const language of wanted) {
    const texts = BY_LANGUAGE.get(language.toLowerCase().split("-")[0] ?? "");
    if (texts) return texts;
  }
  return en;
}
