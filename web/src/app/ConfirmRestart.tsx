import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { postProcedureConfirmation } from "../api";
import { RejectionNote } from "../rest/RejectionNote";
import { useAction } from "../rest/useAction";
import { useTexts } from "../texts/TextsContext";
import { useFrequentProcedure } from "./procedure";
import { useSession } from "./session";

/** After a restart: why navigation is stopped, and the operator's button to continue. Otherwise nothing. */
export function ConfirmRestart(): ReactNode {
  const { view } = useLive();
  const [stopped, setStopped] = useState(false);
  // Without pictures it is unknown whether the confirmation is still needed: keep showing it.
  const snapshot = view.newest?.snapshot ?? null;
  const isStopped = snapshot === null ? stopped : snapshot.withheld === "NOT_CONFIRMED";
  if (isStopped !== stopped) setStopped(isStopped);
  return isStopped ? <Question /> : null;
}

function Question(): ReactNode {
  const texts = useTexts().restart;
  const { session } = useSession();
  const { data, refetch } = useFrequentProcedure();
  const doing = useAction();
  const [needed, setNeeded] = useState(data?.confirmation ?? null);
  // The same applies while the server does not answer.
  if (data !== null && data.confirmation !== needed) setNeeded(data.confirmation);
  if (needed === null) return null;
  const isOperator = session.state === "in" && session.who.role === "operator";
  const confirm = async (): Promise<void> => {
    await doing.run(async () => {
      const body = { registration_id: needed.registration_id };
      await postProcedureConfirmation({ body });
    });
    refetch();
  };
  return (
    <section className="restart" role="alert" aria-labelledby="restart-title">
      <div className="restart-words">
        <h2 id="restart-title">
          <span aria-hidden="true">■</span> {texts.title}: {needed.vertebra}
        </h2>
        <p>{texts.because[needed.because]}</p>
        <p>
          {needed.reference === null ? texts.look.camera : texts.look.reference} {texts.orCheck}
          {!isOperator && ` ${texts.others}`}
        </p>
        <RejectionNote rejection={doing.rejection} />
      </div>
      {isOperator && (
        <Button className="restart-confirm" loading={doing.busy} onClick={() => void confirm()}>
          {texts.confirm} {needed.vertebra}
        </Button>
      )}
    </section>
  );
}
