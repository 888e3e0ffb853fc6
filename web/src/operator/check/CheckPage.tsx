import { useState, type ReactNode } from "react";
import { getRegistration } from "../../api";
import { EmptyState } from "../../panes/EmptyState";
import { PageLink } from "../../rest/PageLink";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { useTexts } from "../../texts/TextsContext";
import { useProcedure } from "../../app/procedure";
import { usedLandmarks } from "../registration/planReader";
import { RegistrationRejection } from "../registration/RegistrationRejection";
import { useActiveProcedures } from "../registration/useActiveProcedures";
import { CheckChoice } from "./CheckChoice";
import { CheckDue } from "./CheckDue";
import { CheckWork } from "./CheckWork";

/** Check on anatomy: an unused landmark decides whether navigation is allowed. */
export function CheckPage(): ReactNode {
  const texts = useTexts().check;
  const procedure = useProcedure();
  const register = procedure.data?.steps.find((one) => one.step === "register");
  if (register === undefined) return <QueryStatus query={procedure} />;
  if (register.state !== "done" || register.document_id === null)
    return (
      <EmptyState drawing="registration" sentence={texts.needsRegistration} testId="check-shut">
        <PageLink page="register" />
      </EmptyState>
    );
  return <Checking key={register.document_id} registrationId={register.document_id} />;
}

function Checking({ registrationId }: { registrationId: string }): ReactNode {
  const running = useActiveProcedures();
  const [stored, setStored] = useState(0);
  const registration = useQuery((signal) => getRegistration({ signal }), {
    key: registrationId,
  });
  if (registration.data === null) return <QueryStatus query={registration} Note={RegistrationRejection} />;
  const { check, vertebra } = registration.data;
  return (
    <div className="registration">
      <CheckDue rule={check} fresh={stored === 0 ? null : String(stored)} />
      {running.data === null ? (
        <QueryStatus query={running} Note={RegistrationRejection} />
      ) : running.data.check ? (
        <CheckWork
          onOver={running.refetch}
          onStored={() => {
            setStored(stored + 1);
          }}
        />
      ) : (
        <CheckChoice
          vertebra={vertebra}
          used={usedLandmarks(registration.data.made_from)}
          maxMm={check.max_mm}
          onBegun={running.refetch}
        />
      )}
    </div>
  );
}
