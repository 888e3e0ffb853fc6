import type { ReactNode } from "react";
import { shownTime } from "../operator/parts/shown";
import { filled } from "../words/filled";
import type { components } from "../schema";
import { useWords } from "../words/WordsContext";

/** One signature: who, when, whether that is known to be a second person, and who had invited them. */
export function SignatureLine({ of: one }: { of: components["schemas"]["SignatureMessage"] }): ReactNode {
  const all = useWords();
  const words = all.supervisor.sign;
  return (
    <>
      <span aria-hidden="true">{one.second_person ? "✓" : "○"}</span> {words.signedBy} <b>{one.by}</b>,{" "}
      {shownTime(one.at, all.language)}
      {!one.second_person && ` · ${words.notSecond}`}
      {one.invited_by_maker
        ? ` · ${filled(words.invitedByMaker, { name: one.invited_by })}`
        : one.invited_by !== "" && ` · ${words.invitedBy} ${one.invited_by}`}
    </>
  );
}
