import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { useProcedure } from "../app/procedure";
import { postRecordingsConsent } from "../api";
import { RejectionNote } from "../rest/RejectionNote";
import { useAction } from "../rest/useAction";
import { useTexts } from "../texts/TextsContext";
import { isConsentPromptDue } from "./consent";

interface ConsentAnswersProps {
  caseId: string;
  /** Called after the answer was stored. */
  onAnswer: (isGiven: boolean) => void;
}

/** The two answers, stored in the case under the user's name. */
export function ConsentAnswers({ caseId, onAnswer }: ConsentAnswersProps): ReactNode {
  const texts = useTexts().recording.consent;
  const doing = useAction();
  const answer = async (isGiven: boolean): Promise<void> => {
    const isStored = await doing.run(async () => {
      const body = { case_id: caseId, is_given: isGiven };
      await postRecordingsConsent({ body });
    });
    if (isStored) onAnswer(isGiven);
  };
  return (
    <>
      <div className="enter-choices consent-choices">
        <Button size="lg" loading={doing.busy} data-testid="consent-yes" onClick={() => void answer(true)}>
          {texts.yes}
        </Button>
        <Button
          size="lg"
          variant="default"
          disabled={doing.busy}
          data-testid="consent-no"
          onClick={() => void answer(false)}
        >
          {texts.no}
        </Button>
      </div>
      <RejectionNote rejection={doing.rejection} />
    </>
  );
}

/** If recording begins with navigation: asks before the first recording. Nothing once it is answered. */
export function ConsentQuestion(): ReactNode {
  const texts = useTexts().recording.consent;
  const { data, refetch } = useProcedure();
  if (data?.case_id == null || data.recording === null || !isConsentPromptDue(data.recording)) return null;
  return (
    <section className="restart" aria-labelledby="consent-title" data-testid="consent-question">
      <div className="restart-words">
        <h2 id="consent-title">{texts.title}</h2>
        <p>{texts.navigating}</p>
      </div>
      <div>
        <ConsentAnswers caseId={data.case_id} onAnswer={refetch} />
      </div>
    </section>
  );
}
