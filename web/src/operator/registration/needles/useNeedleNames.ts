import { useTexts } from "../../../texts/TextsContext";

/** Names of the reference lines in the page's language; a landmark keeps its own. */
export function useNeedleNames(): (name: string) => string {
  const texts = useTexts().registration.line;
  return (name) => (Object.hasOwn(texts, name) ? texts[name as keyof typeof texts] : name);
}
