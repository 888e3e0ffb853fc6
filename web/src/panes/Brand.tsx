import type { ReactNode } from "react";
import { useWords } from "../words/WordsContext";

/** Whose page this is, and that it is no medical device. */
export function Brand(): ReactNode {
  const words = useWords();
  return (
    <div className="brand">
      <img src="/coaxial.svg" alt="" width={44} height={44} />
      <div>
        <h1>{words.product}</h1>
        <p className="notice">{words.notice}</p>
      </div>
    </div>
  );
}
