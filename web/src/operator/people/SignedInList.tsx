import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { deletePeopleSessionsBySessionId, type SignedInMessage } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { formatTime } from "../parts/format";

interface Props {
  sessions: SignedInMessage[];
  onEnded: () => void;
}

/** Sessions, each with a button to end it. */
export function SignedInList({ sessions, onEnded }: Props): ReactNode {
  const all = useTexts();
  const texts = all.people;
  const { busy, rejection, run } = useAction();
  const end = async (session_id: string): Promise<void> => {
    await deletePeopleSessionsBySessionId({ path: { session_id } });
    onEnded();
  };
  return (
    <section aria-labelledby="signed-in">
      <h3 id="signed-in">{texts.signedIn}</h3>
      <RejectionNote rejection={rejection} />
      {sessions.length === 0 && <p>{texts.nobody}</p>}
      <ul className="people-list">
        {sessions.map((one) => (
          <li key={one.id}>
            <span>
              <strong>{one.name}</strong> · {all.signIn.role[one.role]}
              {one.for_machine && ` · ${texts.machine}`}
              <small>
                {texts.until} {formatTime(one.expires_at, all.language)}
              </small>
            </span>
            {one.is_own ? (
              <span className="people-you">{texts.you}</span>
            ) : (
              <Button
                size="lg"
                variant="default"
                disabled={busy}
                aria-label={`${texts.endHint} ${one.name}`}
                onClick={() => void run(() => end(one.id))}
              >
                {texts.end}
              </Button>
            )}
          </li>
        ))}
      </ul>
    </section>
  );
}
