import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { answered, server } from "../rest/client";
import { RefusalNote } from "../rest/RefusalNote";
import { useAsked } from "../rest/useAsked";
import { useDo } from "../rest/useDo";
import { useWords } from "../words/WordsContext";
import { useSession } from "./session";

const ASK_EVERY_MS = 1000;

/** After a start: why navigation is stopped, and the operator's button to go on. Nothing at other times. */
export function ConfirmRestart(): ReactNode {
  const { view } = useLive();
  return view.newest?.snapshot?.withheld === "NOT_CONFIRMED" ? <Question /> : null;
}

function Question(): ReactNode {
  const words = useWords().restart;
  const { session } = useSession();
  const { data, again } = useAsked((signal) => answered(server.GET("/api/procedure", { signal })), {
    everyMs: ASK_EVERY_MS,
  });
  const doing = useDo();
  const needed = data?.confirmation ?? null;
  if (needed === null) return null;
  const isOperator = session.state === "in" && session.who.role === "operator";
  const confirm = async (): Promise<void> => {
    await doing.run(async () => {
      const body = { registration_id: needed.registration_id };
      await answered(server.POST("/api/procedure/confirmation", { body }));
    });
    again();
  };
  return (
    <section className="restart" role="alert" aria-labelledby="restart-title">
      <div className="restart-words">
        <h2 id="restart-title">
          <span aria-hidden="true">&#x23F8;</span> {words.title}: {needed.vertebra}
        </h2>
        <p>{words.because[needed.because]}</p>
        <p>
          {needed.reference === null ? words.look.camera : words.look.reference} {words.orCheck}
          {!isOperator && ` ${words.others}`}
        </p>
        <RefusalNote refusal={doing.refusal} />
      </div>
      {isOperator && (
        <Button className="restart-confirm" loading={doing.busy} onClick={() => void confirm()}>
          {words.confirm} {needed.vertebra}
        </Button>
      )}
    </section>
  );
}
