import type { ReactNode } from "react";
import { useProcedure } from "../app/procedure";
import { useTexts } from "../texts/TextsContext";
import { useSides } from "./registration/useSides";
import { helpfulRemedies, remedyText, setupSentence } from "./setupCheckText";

/** Whether the planned screw can be navigated, before navigation starts, and what would help. Blocks nothing. */
export function SetupCheckNote(): ReactNode {
  const texts = useTexts().setupCheck;
  const sideName = useSides();
  const check = useProcedure().data?.setup_check ?? null;
  if (check === null) return null;
  const { suffices } = check.found;
  const remedies = helpfulRemedies(check);
  const sentence = setupSentence(check, sideName(check.side), texts);
  if (suffices)
    return (
      <p className="quiet" role="status" data-testid="setup-check" data-suffices>
        ✓ {sentence}
      </p>
    );
  return (
    <section className="card" aria-label={texts.title} data-testid="setup-check">
      <p className="warning" role="status">
        ▲ {sentence}
      </p>
      {remedies.length > 0 && (
        <>
          <p>{texts.remedies}</p>
          <ul className="said" data-testid="setup-remedies">
            {remedies.map((remedy) => (
              <li key={`${remedy.kind} ${String(remedy.landmarks)}`}>{remedyText(remedy, texts)}</li>
            ))}
          </ul>
        </>
      )}
    </section>
  );
}
