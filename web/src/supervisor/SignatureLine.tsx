import type { ReactNode } from "react";
import { formatTime } from "../operator/parts/format";
import { interpolate } from "../texts/interpolate";
import type { SignatureMessage } from "../api";
import { useTexts } from "../texts/TextsContext";

/** One signature: who, when, whether it is certainly a second person, and who invited them. */
export function SignatureLine({ of: one }: { of: SignatureMessage }): ReactNode {
  const all = useTexts();
  const texts = all.supervisor.sign;
  return (
    <>
      <span aria-hidden="true">{one.second_person ? "✓" : "○"}</span> {texts.signedBy} <b>{one.by}</b>,{" "}
      {formatTime(one.at, all.language)}
      {!one.second_person && ` · ${texts.notSecond}`}
      {one.invited_by_maker
        ? ` · ${interpolate(texts.invitedByMaker, { name: one.invited_by })}`
        : one.invited_by !== "" && ` · ${texts.invitedBy} ${one.invited_by}`}
    </>
  );
}
