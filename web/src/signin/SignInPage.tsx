import { Button, Loader, TextInput } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { Link } from "wouter";
import { useSession, type Session } from "../app/session";
import { homeOf } from "../app/views";
import type { Rejection } from "../rest/client";
import { personName } from "../room/personName";
import type { Texts } from "../texts/en";
import type { SignInTexts } from "../texts/signin/en";
import { useTexts } from "../texts/TextsContext";
import { About } from "./About";
import { LinkHelp } from "./LinkHelp";
import { tokenIn } from "./token";
import { useSignIn } from "./useSignIn";

interface SignInMessage {
  kind: string;
  title: string;
  sentence: string;
}

/** The sign-in page, for users without a session and for invitation links. */
export function SignInPage(): ReactNode {
  const all = useTexts();
  const texts = all.signIn;
  const { session } = useSession();
  const { busy, rejection, signIn } = useSignIn();
  const [typed, setTyped] = useState("");
  const token = tokenIn(typed);
  const message = messageFor(session, rejection, all);
  const waiting = busy || (session.state === "asking" && !session.silent);
  const isNew = !waiting && message.kind === "needed";
  return (
    <main className="enter" data-new={isNew || undefined}>
      <div className="enter-column">
        <header>
          <img src="/coaxial.svg" alt="" width={72} height={72} />
          <h1>{all.product}</h1>
          <p className="notice">{all.notice}</p>
        </header>
        {isNew && <About />}
      </div>
      <div className="enter-column">
        {waiting ? (
          <p role="status" className="enter-waiting">
            <Loader size="md" aria-hidden="true" /> {busy ? texts.entering : texts.asking}
          </p>
        ) : (
          <section
            role={rejection === null ? "status" : "alert"}
            data-testid="enter"
            data-kind={message.kind}
          >
            <h2>{message.title}</h2>
            <p>{message.sentence}</p>
          </section>
        )}
        {session.state === "in" && !busy && (
          <Link className="enter-on" href={session.isHub ? "/" : homeOf(session.who.role)}>
            {texts.goOn}
          </Link>
        )}
        {session.state !== "asking" && !busy && (
          <form
            onSubmit={(event) => {
              event.preventDefault();
              if (token !== null) signIn(token);
            }}
          >
            <TextInput
              size="lg"
              type="password"
              autoComplete="off"
              label={texts.paste}
              description={texts.pasteHint}
              error={typed.trim() !== "" && token === null ? texts.noLink : undefined}
              value={typed}
              onChange={(event) => {
                setTyped(event.currentTarget.value);
              }}
            />
            <Button type="submit" size="lg" disabled={token === null}>
              {texts.signIn}
            </Button>
          </form>
        )}
        {session.state === "out" && !busy && <LinkHelp />}
      </div>
    </main>
  );
}

/** Title and sentence of a rejection, in the page's words if it has them. */
function messageFor(session: Session, rejection: Rejection | null, all: Texts): SignInMessage {
  const texts = all.signIn;
  if (rejection !== null) {
    const { code, message, remedy, context } = rejection.problem;
    const text = texts.rejected[code as keyof SignInTexts["rejected"]] as RejectionText | undefined;
    const wait = typeof context["wait_s"] === "number" ? ` (${String(context["wait_s"])} s)` : "";
    if (text !== undefined) return { kind: code, title: text.title, sentence: text.sentence + wait };
    return { kind: code, title: message, sentence: remedy };
  }
  if (session.state === "asking") return { kind: "silent", ...texts.silent };
  if (session.state === "in") {
    return {
      kind: "in",
      title: `${texts.signedInAs} ${personName(session.who.name, all)}`,
      sentence: texts.role[session.who.role],
    };
  }
  return session.expired ? { kind: "expired", ...texts.expired } : { kind: "needed", ...texts.needed };
}

interface RejectionText {
  title: string;
  sentence: string;
}
