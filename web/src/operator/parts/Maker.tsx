import type { ReactNode } from "react";
import type { ImportedMessage } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { formatTime } from "./format";

interface Made {
  made_by: string | null;
  imported: ImportedMessage | null;
}

/** Author of a document. For imported documents: according to the archive, and who imported it. */
export function Maker({ of: made }: { of: Made }): ReactNode {
  const { case: texts, language } = useTexts();
  if (made.imported === null) return made.made_by ?? "";
  const { claimed_maker, by, at } = made.imported;
  return (
    <span data-imported="true">
      {claimed_maker}, {texts.maker.saysArchive} ({texts.maker.takenIn} {by}, {formatTime(at, language)})
    </span>
  );
}
