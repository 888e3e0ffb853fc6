import type { ReactNode } from "react";
import { useSession } from "../app/session";
import { Maker } from "../operator/parts/Maker";
import { deleteSupervisionSignaturesBySignatureId, postSupervisionSignatures } from "../api";
import { RejectionNote } from "../rest/RejectionNote";
import { formatTime } from "../operator/parts/format";
import { useAction } from "../rest/useAction";
import type { Signable } from "../room/messages";
import { useTexts } from "../texts/TextsContext";
import { SignatureLine } from "./SignatureLine";
import { TwoStepButton } from "./TwoStepButton";

/** Shows what is signed and who made it; signs it or withdraws the signature. */
export function SignBox({ signable }: { signable: Signable }): ReactNode {
  const all = useTexts();
  const texts = all.supervisor.sign;
  const { session } = useSession();
  const { busy, rejection, run } = useAction();
  const { document_id, signatures, what } = signable;
  if (document_id === null) return null;
  const mine = signatures.find((one) => one.is_yours);
  const anybody = session.state === "in" && !session.required;
  return (
    <section
      className="sign"
      aria-label={texts.title}
      data-testid={`sign-${what}`}
      data-signed={signable.is_cosigned}
    >
      <h3>
        {texts.title} <small>({texts[signable.requirement]})</small>
      </h3>
      <p>
        {texts.signs} <b>{signable.title}</b>, {texts.madeBy} <Maker of={signable} />,{" "}
        {formatTime(signable.made_at, all.language)}, {texts.print}{" "}
        <code title={signable.sha256}>{signable.sha256.slice(0, 12)}</code>
      </p>
      {signable.out_of_date !== "" && (
        <p className="warn">
          ▲ {texts.outOfDate}: {signable.out_of_date}
        </p>
      )}
      {signable.was_signed && <p className="warn">▲ {texts.changed}</p>}
      {signatures.length === 0 ? (
        <p className="soft">{texts.none}</p>
      ) : (
        <ul>
          {signatures.map((one) => (
            <li key={one.id}>
              <SignatureLine of={one} />
            </li>
          ))}
        </ul>
      )}
      {anybody && <p className="soft">{texts.anybody}</p>}
      {mine === undefined ? (
        signable.out_of_date === "" && (
          <TwoStepButton
            testid={`cosign-${what}`}
            className="sign-button"
            first={texts.sign}
            second={texts.sure}
            busy={busy}
            onDone={() =>
              void run(async () => {
                await postSupervisionSignatures({ body: { what, document_id } });
              })
            }
          />
        )
      ) : (
        <TwoStepButton
          testid={`unsign-${what}`}
          first={texts.takeBack}
          second={texts.takeBack}
          busy={busy}
          onDone={() =>
            void run(async () => {
              const path = { signature_id: mine.id };
              await deleteSupervisionSignaturesBySignatureId({ path });
            })
          }
        />
      )}
      <RejectionNote rejection={rejection} />
    </section>
  );
}
