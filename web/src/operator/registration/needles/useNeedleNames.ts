import { useWords } from "../../../words/WordsContext";

/** The three lines of a reference slice in the page's language; a landmark keeps its own name. */
export function useNeedleNames(): (name: string) => string {
  const words = useWords().registration.line;
  return (name) => (Object.hasOwn(words, name) ? words[name as keyof typeof words] : name);
}
