import type { ReactNode } from "react";
import { useWords } from "../words/WordsContext";

/** The door: for those who are not signed in. */
export function EnterPage(): ReactNode {
  const words = useWords();
  return (
    <main className="enter">
      <h1>{words.product}</h1>
      <p>{words.notice}</p>
      <p>{words.enter.needed}</p>
    </main>
  );
}
