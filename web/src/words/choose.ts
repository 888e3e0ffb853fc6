// Which language the page speaks: `?lang=` wins, then the browser's, then English.
import { de } from "./de";
import { en, type Words } from "./en";

const BY_LANGUAGE = new Map<string, Words>([en, de].map((words) => [words.language, words]));

export function wordsFor(query: string, browserLanguages: readonly string[]): Words {
  const wanted = [new URLSearchParams(query).get("lang") ?? "", ...browserLanguages];
  for (const language of wanted) {
    const words = BY_LANGUAGE.get(language.toLowerCase().split("-")[0] ?? "");
    if (words) return words;
  }
  return en;
}
