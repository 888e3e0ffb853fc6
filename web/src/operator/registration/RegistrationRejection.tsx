import type { ReactNode } from "react";
import { Rejection } from "../../rest/client";
import { RejectionNote } from "../../rest/RejectionNote";
import { useTexts } from "../../texts/TextsContext";

/** A rejection with what to do on this page, where the server can only name its own doors. */
export function RegistrationRejection({ rejection }: { rejection: Rejection | null }): ReactNode {
  const texts = useTexts().registration.remedies;
  if (rejection === null) return null;
  const { problem } = rejection;
  const here = Object.hasOwn(texts, problem.code) ? texts[problem.code as keyof typeof texts] : null;
  return (
    <RejectionNote rejection={here === null ? rejection : new Rejection({ ...problem, remedy: here })} />
  );
}
