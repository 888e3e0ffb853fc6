import { Button, TextInput } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { deleteSession, getSession, postSession, type SessionMessage } from "../api";
import type { Rejection } from "../rest/client";
import { QueryStatus } from "../rest/QueryStatus";
import { RejectionNote } from "../rest/RejectionNote";
import { useAction } from "../rest/useAction";
import { useQuery, type QueryState } from "../rest/useQuery";
import { tokenIn } from "../signin/token";
import { interpolate } from "../texts/interpolate";
import { useTexts } from "../texts/TextsContext";

const ASK_EVERY_MS = 5000;
const WITHOUT_SESSION = new Set(["SESSION_NEEDED", "SESSION_EXPIRED"]);

/** The person's session at the opened theatre itself. */
export function useTheatreSession(): QueryState<SessionMessage> {
  return useQuery((signal) => getSession({ signal }), { everyMs: ASK_EVERY_MS });
}

interface TheatreSessionProps {
  theatre: string;
  query: QueryState<SessionMessage>;
}

/** Who is signed in at the theatre, or how to sign in there; the theatre decides what this person may do. */
export function TheatreSession({ theatre, query }: TheatreSessionProps): ReactNode {
  const texts = useTexts().hub.session;
  const { busy, rejection, run } = useAction();
  if (query.data === null) {
    return isWithoutSession(query.rejection) ? (
      <SignInThere theatre={theatre} onDone={query.refetch} />
    ) : (
      <QueryStatus query={query} />
    );
  }
  const leave = async (): Promise<void> => {
    await deleteSession();
    query.refetch();
  };
  return (
    <section aria-label={texts.title} data-testid="theatre-session">
      <p>
        {interpolate(texts.signedIn, { theatre })} <b>{query.data.name}</b>
      </p>
      <Button variant="default" size="lg" loading={busy} onClick={() => void run(leave)}>
        {texts.leave}
      </Button>
      <RejectionNote rejection={rejection} />
    </section>
  );
}

function isWithoutSession(rejection: Rejection | null): boolean {
  return rejection !== null && WITHOUT_SESSION.has(rejection.problem.code);
}

function SignInThere({ theatre, onDone }: { theatre: string; onDone: () => void }): ReactNode {
  const all = useTexts();
  const texts = all.hub.session;
  const [typed, setTyped] = useState("");
  const { busy, rejection, run } = useAction();
  const token = tokenIn(typed);
  const enter = async (invitation: string): Promise<void> => {
    await postSession({ body: { invitation } });
    setTyped("");
    onDone();
  };
  return (
    <form
      className="theatre-enter"
      data-testid="theatre-enter"
      onSubmit={(event) => {
        event.preventDefault();
        if (token !== null) void run(() => enter(token));
      }}
    >
      <p>{interpolate(texts.needed, { theatre })}</p>
      <TextInput
        size="lg"
        type="password"
        autoComplete="off"
        label={interpolate(texts.paste, { theatre })}
        error={typed.trim() !== "" && token === null ? all.signIn.noLink : undefined}
        value={typed}
        onChange={(event) => {
          setTyped(event.currentTarget.value);
        }}
      />
      <Button type="submit" size="lg" disabled={token === null} loading={busy}>
        {all.signIn.signIn}
      </Button>
      <RejectionNote rejection={rejection} />
    </form>
  );
}
