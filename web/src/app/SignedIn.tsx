import { Button, Modal } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { RefusalNote } from "../rest/RefusalNote";
import { useDo } from "../rest/useDo";
import { useWords } from "../words/WordsContext";
import { useSession } from "./session";

/** Who is signed in, and the way out; nothing where nobody has to sign in. */
export function SignedIn(): ReactNode {
  const words = useWords().enter;
  const { session, leave } = useSession();
  const [asked, setAsked] = useState(false);
  const { busy, refusal, run, forget } = useDo();
  if (session.state !== "in" || !session.required) return null;
  const { name, role } = session.who;
  const close = (): void => {
    setAsked(false);
    forget();
  };
  return (
    <>
      <Button
        variant="default"
        size="lg"
        onClick={() => {
          setAsked(true);
        }}
        data-testid="signed-in"
      >
        {name} · {words.role[role]}
      </Button>
      <Modal opened={asked} onClose={close} title={words.leaveTitle} centered withCloseButton={false}>
        <p>{words.leaveSentence}</p>
        <RefusalNote refusal={refusal} />
        <div className="enter-choices">
          <Button size="lg" variant="default" onClick={close}>
            {words.stay}
          </Button>
          <Button size="lg" loading={busy} onClick={() => void run(leave)} data-testid="sign-out">
            {words.leave}
          </Button>
        </div>
      </Modal>
    </>
  );
}
