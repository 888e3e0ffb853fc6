import { Alert } from "@mantine/core";
import type { ReactNode } from "react";
import { SignedIn } from "../../app/SignedIn";
import { getPeople } from "../../api";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { useTexts } from "../../texts/TextsContext";
import { AuditLog } from "./AuditLog";
import { InvitationForm } from "./InvitationForm";
import { InvitedList } from "./InvitedList";
import { SignedInList } from "./SignedInList";

const ASK_EVERY_MS = 3000;

/** The people page: sessions, invitations, audit log. */
export function PeoplePage(): ReactNode {
  const texts = useTexts().people;
  const query = useQuery((signal) => getPeople({ signal }), {
    everyMs: ASK_EVERY_MS,
  });
  const { data, refetch } = query;
  return (
    <div className="people">
      {data === null && <QueryStatus query={query} />}
      <SignedIn />
      {data?.sign_in_required === false && <Alert title={texts.off} />}
      {data?.sign_in_required === true && (
        <>
          <InvitationForm onInvited={refetch} />
          <SignedInList sessions={data.sessions} onEnded={refetch} />
          <InvitedList invitations={data.invitations} onRevoked={refetch} />
        </>
      )}
      <AuditLog />
    </div>
  );
}
