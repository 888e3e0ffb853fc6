import type { ReactNode } from "react";
import { useWords } from "../../words/WordsContext";
import type { Rehearsed } from "../../rest/useRehearsal";

/** Only a rehearsal knows where the tip really rests. */
export function TipRests({ told }: { told: Rehearsed }): ReactNode {
  const words = useWords().registration.rehearsal;
  const touched = told.truth?.moment?.touched ?? "";
  return (
    <p data-testid="tip-rests" data-landmark={touched}>
      {touched === "" ? words.inTheAir : `${words.restsOn} ${touched}`}
    </p>
  );
}
