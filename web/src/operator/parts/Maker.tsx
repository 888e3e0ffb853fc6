import type { ReactNode } from "react";
import type { components } from "../../schema";
import { useWords } from "../../words/WordsContext";
import { shownTime } from "./shown";

interface Made {
  made_by: string | null;
  imported: components["schemas"]["ImportedMessage"] | null;
}

/** Who made something; of what came in with an archive, that only the archive says so, and who took it in. */
export function Maker({ of: made }: { of: Made }): ReactNode {
  const { case: words, language } = useWords();
  if (made.imported === null) return made.made_by ?? "";
  const { claimed_maker, by, at } = made.imported;
  return (
    <span data-imported="true">
      {claimed_maker}, {words.maker.saysArchive} ({words.maker.takenIn} {by}, {shownTime(at, language)})
    </span>
  );
}
