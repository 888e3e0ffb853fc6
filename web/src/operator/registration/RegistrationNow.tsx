import { Badge } from "@mantine/core";
import type { ReactNode } from "react";
import { Link } from "wouter";
import {
  getRegistration,
  type RegistrationMessage,
  postCasesByCaseIdDocumentsByDocumentIdWithdrawal,
} from "../../api";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { useAction } from "../../rest/useAction";
import { useTexts } from "../../texts/TextsContext";
import { Maker } from "../parts/Maker";
import { formatTime } from "../parts/format";
import { useProcedure } from "../../app/procedure";
import { interpolate } from "../../texts/interpolate";
import { RegistrationRejection } from "./RegistrationRejection";
import { RegistrationNumbers } from "./RegistrationNumbers";
import { ConfirmOrCancelButton } from "./ConfirmOrCancelButton";
import { useMadeBy } from "./useMadeBy";

interface Begun {
  method: RegistrationMessage["method"];
  href: string;
}

/** The current registration: method, values and next actions; without one, whether one is in progress, and where. */
export function RegistrationNow({ begun }: { begun: Begun | null }): ReactNode {
  const { data } = useProcedure();
  const step = data?.steps.find((one) => one.step === "register");
  const texts = useTexts().registration;
  if (data === null || step === undefined) return null;
  // A withdrawn registration has no actions; the head of the step states the reason.
  if (step.document_id === null || step.state !== "done")
    return (
      <p data-testid="registration-none">
        {begun === null ? (
          texts.now.none
        ) : (
          <>
            {interpolate(texts.now.begun, { method: texts.method[begun.method] })}{" "}
            <Link className="big-link" href={begun.href}>
              {texts.choice.begun}
            </Link>
          </>
        )}
      </p>
    );
  return <Newest key={step.document_id} caseId={data.case_id ?? ""} documentId={step.document_id} />;
}

function Newest({ caseId, documentId }: { caseId: string; documentId: string }): ReactNode {
  const all = useTexts();
  const texts = all.registration;
  const procedure = useProcedure();
  const madeBy = useMadeBy();
  const query = useQuery((signal) => getRegistration({ signal }), {
    key: documentId,
  });
  const withdrawing = useAction();
  const { data } = query;
  if (data === null) return <QueryStatus query={query} Note={RegistrationRejection} />;
  const { heading } = data;
  const lost = heading.withdrawn?.reason ?? heading.out_of_date;
  const check = procedure.data?.steps.find((one) => one.step === "check");
  return (
    <>
      <section className="card" data-testid="registration-now">
        <h3>
          {interpolate(texts.now.title, { vertebra: data.vertebra, version: heading.version })}{" "}
          <Badge size="lg" color={heading.current ? "teal" : "yellow"}>
            {heading.current ? texts.now.holds : texts.now.lost}
          </Badge>
        </h3>
        <p>
          {texts.method[data.method]} · <Maker of={heading} /> · {formatTime(heading.made_at, all.language)} ·{" "}
          {data.reference === null
            ? texts.now.toCamera
            : interpolate(texts.now.toMarker, { marker: data.reference })}
        </p>
        {lost !== null && <p className="warning">▲ {lost}</p>}
        <RegistrationNumbers method={data.method} numbers={data.numbers} />
        <RegistrationRejection rejection={withdrawing.rejection} />
        <div className="row">
          {heading.current && (
            <>
              <Link className="big-link" href="/operator/check" data-testid="to-check">
                {check?.state === "done" ? texts.now.checked : texts.now.toCheck}
              </Link>
              <Link className="big-link" href="/operator/register/nudges" data-testid="to-nudges">
                {texts.now.nudge}
              </Link>
              <ConfirmOrCancelButton
                needsConfirmation
                variant="default"
                confirmLabel={texts.now.withdrawSure}
                busy={withdrawing.busy}
                onConfirm={() => {
                  void withdrawing
                    .run(async () => {
                      await postCasesByCaseIdDocumentsByDocumentIdWithdrawal({
                        path: { case_id: caseId, document_id: heading.id },
                        body: { by: madeBy, reason: texts.now.withdrawReason },
                      });
                    })
                    .then(() => {
                      query.refetch();
                      procedure.refetch();
                    });
                }}
              >
                {texts.now.withdraw}
              </ConfirmOrCancelButton>
            </>
          )}
        </div>
      </section>
      <p className="quiet">{texts.choice.ends}</p>
    </>
  );
}
