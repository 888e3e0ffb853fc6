import type { ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";
import type { Rehearsed } from "../../rest/useRehearsal";

/** Ground truth of the tip's contact; known only in a rehearsal. */
export function TipContact({ rehearsal }: { rehearsal: Rehearsed }): ReactNode {
  const texts = useTexts().registration.rehearsal;
  const touched = rehearsal.truth?.moment?.touched ?? "";
  return (
    <p data-testid="tip-rests" data-landmark={touched}>
      {touched === "" ? texts.inTheAir : `${texts.restsOn} ${touched}`}
    </p>
  );
}
