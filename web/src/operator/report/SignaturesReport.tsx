import type { ReactNode } from "react";
import { getSupervisionSignatures } from "../../api";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { SignatureLine } from "../../supervisor/SignatureLine";
import { useTexts } from "../../texts/TextsContext";
import { Maker } from "../parts/Maker";

/** Signatures of plan and registration, and who invited the signers. */
export function SignaturesReport(): ReactNode {
  const texts = useTexts().supervisor.sign;
  const query = useQuery((signal) => getSupervisionSignatures({ signal }));
  const { data } = query;
  if (data === null) return <QueryStatus query={query} />;
  const there = data.signable.filter((one) => one.document_id !== null);
  if (there.length === 0) return null;
  return (
    <section className="stack" data-testid="report-signatures">
      <h4>{texts.title}</h4>
      {there.map((signable) => (
        <div key={signable.what}>
          <p>
            <b>{signable.title}</b>, {texts.madeBy} <Maker of={signable} />
          </p>
          {signable.signatures.length === 0 ? (
            <p className="soft">{texts.none}</p>
          ) : (
            <ul>
              {signable.signatures.map((one) => (
                <li key={one.id}>
                  <SignatureLine of={one} />
                </li>
              ))}
            </ul>
          )}
        </div>
      ))}
    </section>
  );
}
