import type { ReactNode } from "react";
import type { HeadingMessage } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { documentTitle } from "../case/documentTitle";
import { sentence } from "./format";

type Heading = HeadingMessage;

/** Validity of a document, and what it depends on. */
export function DocumentValidity({
  heading,
  documents,
}: {
  heading: Heading;
  /** Null until known; then dependencies are omitted. */
  documents: readonly Heading[] | null;
}): ReactNode {
  const texts = useTexts().case;
  const bases = (documents === null ? [] : heading.depends_on).map((id) => {
    const found = documents?.find((one) => one.id === id);
    return found === undefined
      ? texts.another
      : `${documentTitle(found, texts)}, ${texts.version} ${String(found.version)}`;
  });
  return (
    <p className="soft">
      <span className={heading.current ? "good" : "bad"}>
        {heading.current ? `✓ ${texts.validities.current}` : `! ${texts.validities.outOfDate}`}
      </span>
      {heading.out_of_date !== null && ` · ${sentence(heading.out_of_date)}`}
      {bases.length > 0 && ` · ${texts.dependsOn} ${bases.join("; ")}`}
    </p>
  );
}
