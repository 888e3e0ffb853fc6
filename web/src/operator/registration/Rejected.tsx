import type { ReactNode } from "react";
import { Rejection } from "../../rest/client";
import { RejectionNote } from "../../rest/RejectionNote";
import { useWords } from "../../words/WordsContext";

/** A refusal with what to do on this page, where the server can only name its own doors. */
export function Rejected({ rejection }: { rejection: Rejection | null }): ReactNode {
  const words = useWords().registration.remedies;
  if (rejection === null) return null;
  const { problem } = rejection;
  const here = Object.hasOwn(words, problem.code) ? words[problem.code as keyof typeof words] : null;
  return (
    <RejectionNote rejection={here === null ? rejection : new Rejection({ ...problem, remedy: here })} />
  );
}
