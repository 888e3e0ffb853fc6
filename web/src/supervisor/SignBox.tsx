import type { ReactNode } from "react";
import { useSession } from "../app/session";
import { Maker } from "../operator/parts/Maker";
import { answered, server } from "../rest/client";
import { RejectionNote } from "../rest/RejectionNote";
import { shownTime } from "../operator/parts/shown";
import { useDo } from "../rest/useDo";
import type { Signable } from "../room/messages";
import { useWords } from "../words/WordsContext";
import { SignatureLine } from "./SignatureLine";
import { TwoSteps } from "./TwoSteps";

/** What exactly is signed, by whom it was, and the way to sign it or to take that back. */
export function SignBox({ signable }: { signable: Signable }): ReactNode {
  const all = useWords();
  const words = all.supervisor.sign;
  const { session } = useSession();
  const { busy, rejection, run } = useDo();
  const { document_id, signatures, what } = signable;
  if (document_id === null) return null;
  const mine = signatures.find((one) => one.is_yours);
  const anybody = session.state === "in" && !session.required;
  return (
    <section
      className="sign"
      aria-label={words.title}
      data-testid={`sign-${what}`}
      data-signed={signable.is_cosigned}
    >
      <h3>
        {words.title} <small>({words[signable.requirement]})</small>
      </h3>
      <p>
        {words.signs} <b>{signable.title}</b>, {words.madeBy} <Maker of={signable} />,{" "}
        {shownTime(signable.made_at, all.language)}, {words.print}{" "}
        <code title={signable.sha256}>{signable.sha256.slice(0, 12)}</code>
      </p>
      {signable.out_of_date !== "" && (
        <p className="warn">
          ▲ {words.outOfDate}: {signable.out_of_date}
        </p>
      )}
      {signable.was_signed && <p className="warn">▲ {words.changed}</p>}
      {signatures.length === 0 ? (
        <p className="soft">{words.none}</p>
      ) : (
        <ul>
          {signatures.map((one) => (
            <li key={one.id}>
              <SignatureLine of={one} />
            </li>
          ))}
        </ul>
      )}
      {anybody && <p className="soft">{words.anybody}</p>}
      {mine === undefined ? (
        signable.out_of_date === "" && (
          <TwoSteps
            testid={`cosign-${what}`}
            className="sign-button"
            first={words.sign}
            second={words.sure}
            busy={busy}
            onDone={() =>
              void run(async () => {
                await answered(server.POST("/api/supervision/signatures", { body: { what, document_id } }));
              })
            }
          />
        )
      ) : (
        <TwoSteps
          testid={`unsign-${what}`}
          first={words.takeBack}
          second={words.takeBack}
          busy={busy}
          onDone={() =>
            void run(async () => {
              const path = { signature_id: mine.id };
              await answered(
                server.DELETE("/api/supervision/signatures/{signature_id}", { params: { path } }),
              );
            })
          }
        />
      )}
      <RejectionNote rejection={rejection} />
    </section>
  );
}
