import { useTexts } from "../../texts/TextsContext";

/** Left and right of the patient in the page's language. */
export function useSides(): (side: string) => string {
  const texts = useTexts().registration.side;
  return (side) => (Object.hasOwn(texts, side) ? texts[side as keyof typeof texts] : side);
}
