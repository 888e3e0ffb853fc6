import { createContext, use } from "react";
import { en, type Words } from "./en";

const WordsContext = createContext<Words>(en);

export const WordsProvider = WordsContext.Provider;

export function useWords(): Words {
  return use(WordsContext);
}
