import type { ReactNode } from "react";
import { Rejection } from "../../rest/client";
import { RejectionNote } from "../../rest/RejectionNote";
import { useTexts } from "../../texts/TextsContext";

/** A rejection with a remedy for this page; the server's remedies name its API. */
export function RegistrationRejection({ rejection }: { rejection: Rejection | null }): ReactNode {
  const texts = useTexts().registration.remedies;
  if (rejection === null) return null;
  const { problem } = rejection;
  const here = Object.hasOwn(texts, problem.code) ? texts[problem.code as keyof typeof texts] : null;
  return (
    <RejectionNote rejection={here === null ? rejection : new Rejection({ ...problem, remedy: here })} />
  );
}
