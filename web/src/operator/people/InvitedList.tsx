import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { EmptyState } from "../../panes/EmptyState";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { deletePeopleInvitationsByInvitationId, type InvitationMessage } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { formatTime } from "../parts/format";

interface Props {
  invitations: InvitationMessage[];
  onRevoked: () => void;
}

/** Invitations with their states; open ones can be withdrawn. */
export function InvitedList({ invitations, onRevoked }: Props): ReactNode {
  const all = useTexts();
  const texts = all.people;
  const { busy, rejection, run } = useAction();
  const revoke = async (invitation_id: string): Promise<void> => {
    const path = { invitation_id };
    await deletePeopleInvitationsByInvitationId({ path });
    onRevoked();
  };
  return (
    <section aria-labelledby="invitations">
      <h3 id="invitations">{texts.invitations}</h3>
      <RejectionNote rejection={rejection} />
      {invitations.length === 0 && <EmptyState drawing="people" sentence={texts.noInvitations} />}
      <ul className="people-list">
        {invitations.map((one) => (
          <li key={one.id} data-state={one.state}>
            <span>
              <strong>{one.name}</strong> · {all.signIn.role[one.role]} · {texts.state[one.state]}
              <small>
                {texts.until} {formatTime(one.expires_at, all.language)}
              </small>
            </span>
            {one.state === "open" && (
              <Button
                size="lg"
                variant="default"
                disabled={busy}
                aria-label={`${texts.revokeHint} ${one.name}`}
                onClick={() => void run(() => revoke(one.id))}
              >
                {texts.revoke}
              </Button>
            )}
          </li>
        ))}
      </ul>
    </section>
  );
}
