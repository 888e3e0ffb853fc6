import { useTexts } from "../../../texts/TextsContext";

/** The three lines of a reference slice in the page's language; a landmark keeps its own name. */
export function useNeedleNames(): (name: string) => string {
  const texts = useTexts().registration.line;
  return (name) => (Object.hasOwn(texts, name) ? texts[name as keyof typeof texts] : name);
}
