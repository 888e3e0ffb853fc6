import type { ReactNode } from "react";
import { Refusal } from "../../rest/client";
import { RefusalNote } from "../../rest/RefusalNote";
import { useWords } from "../../words/WordsContext";

/** A refusal with what to do on this page, where the server can only name its own doors. */
export function Refused({ refusal }: { refusal: Refusal | null }): ReactNode {
  const words = useWords().registration.remedies;
  if (refusal === null) return null;
  const { trouble } = refusal;
  const here = Object.hasOwn(words, trouble.code) ? words[trouble.code as keyof typeof words] : null;
  return <RefusalNote refusal={here === null ? refusal : new Refusal({ ...trouble, remedy: here })} />;
}
