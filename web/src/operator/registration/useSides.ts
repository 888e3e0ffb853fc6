import { useWords } from "../../words/WordsContext";

/** Left and right of the patient in the page's language. */
export function useSides(): (side: string) => string {
  const words = useWords().registration.side;
  return (side) => (Object.hasOwn(words, side) ? words[side as keyof typeof words] : side);
}
