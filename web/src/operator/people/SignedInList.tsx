import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { answered, server } from "../../rest/client";
import { RejectionNote } from "../../rest/RejectionNote";
import { useDo } from "../../rest/useDo";
import type { components } from "../../schema";
import { useWords } from "../../words/WordsContext";
import { shownTime } from "../parts/shown";

interface Props {
  sessions: components["schemas"]["SignedInMessage"][];
  onEnded: () => void;
}

/** Who is in now, and a way to send each away. */
export function SignedInList({ sessions, onEnded }: Props): ReactNode {
  const all = useWords();
  const words = all.people;
  const { busy, rejection, run } = useDo();
  const end = async (session_id: string): Promise<void> => {
    await answered(server.DELETE("/api/people/sessions/{session_id}", { params: { path: { session_id } } }));
    onEnded();
  };
  return (
    <section aria-labelledby="signed-in">
      <h3 id="signed-in">{words.signedIn}</h3>
      <RejectionNote rejection={rejection} />
      {sessions.length === 0 && <p>{words.nobody}</p>}
      <ul className="people-list">
        {sessions.map((one) => (
          <li key={one.id}>
            <span>
              <strong>{one.name}</strong> · {all.enter.role[one.role]}
              {one.for_machine && ` · ${words.machine}`}
              <small>
                {words.until} {shownTime(one.expires_at, all.language)}
              </small>
            </span>
            {one.is_own ? (
              <span className="people-you">{words.you}</span>
            ) : (
              <Button
                size="lg"
                variant="default"
                disabled={busy}
                aria-label={`${words.endHint} ${one.name}`}
                onClick={() => void run(() => end(one.id))}
              >
                {words.end}
              </Button>
            )}
          </li>
        ))}
      </ul>
    </section>
  );
}
