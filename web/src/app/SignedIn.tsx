import { Alert, Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { Link } from "wouter";
import { getPeople } from "../api";
import { OWN_SERVER } from "../hub/openedTheatre";
import { Dialog } from "../panes/Dialog";
import { RejectionNote } from "../rest/RejectionNote";
import { useQuery } from "../rest/useQuery";
import { useAction } from "../rest/useAction";
import { personName, roleBeside } from "../room/personName";
import { useTexts } from "../texts/TextsContext";
import { isOnlyOperator } from "./onlyOperator";
import { useSession } from "./session";

/** Who is signed in, and the sign-out button; nothing if the server requires no sign-in. */
export function SignedIn(): ReactNode {
  const all = useTexts();
  const texts = all.signIn;
  const { session, leave } = useSession();
  const [isConfirming, setIsConfirming] = useState(false);
  const { busy, rejection, run, forget } = useAction();
  const isOperator = session.state === "in" && session.who.role === "operator";
  const { data: people, rejection: silent } = useQuery(
    async (signal) => (isConfirming && isOperator ? getPeople({ ...OWN_SERVER, signal }) : null),
    { key: String(isConfirming && isOperator) },
  );
  if (session.state !== "in" || !session.required) return null;
  const isUnknown = isOperator && people === null && silent === null;
  const isOnly = people !== null && isOnlyOperator(people);
  const { name, role } = session.who;
  const close = (): void => {
    setIsConfirming(false);
    forget();
  };
  return (
    <>
      <Button
        variant="default"
        size="lg"
        onClick={() => {
          setIsConfirming(true);
        }}
        data-testid="signed-in"
      >
        {[personName(name, all), roleBeside(name, texts.role[role], all)]
          .filter((part) => part !== "")
          .join(" · ")}
      </Button>
      <Dialog opened={isConfirming} onClose={close} title={texts.leaveTitle} centered withCloseButton={false}>
        {isOnly ? (
          <Alert className="consequence" title={texts.onlyTitle} role="alert" data-testid="only-operator">
            <p>{texts.onlySentence}</p>
            <Link className="big-link" href="/operator/people" onClick={close}>
              {texts.onlyInvite}
            </Link>
          </Alert>
        ) : (
          <p>{texts.leaveSentence}</p>
        )}
        <RejectionNote rejection={rejection} />
        <div className="enter-choices">
          <Button size="lg" variant={isOnly ? "filled" : "default"} onClick={close}>
            {texts.stay}
          </Button>
          <Button
            size="lg"
            variant={isOnly ? "default" : "filled"}
            // Disabled until it is known whether another operator could return.
            loading={busy || isUnknown}
            onClick={() => void run(leave)}
            data-testid="sign-out"
          >
            {isOnly ? texts.leaveAnyway : texts.leave}
          </Button>
        </div>
      </Dialog>
    </>
  );
}
