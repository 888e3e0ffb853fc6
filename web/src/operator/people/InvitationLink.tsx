import { Alert, Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import type { InvitedMessage } from "../../api";
import { useTexts } from "../../texts/TextsContext";

interface Props {
  invited: InvitedMessage;
  onDone: () => void;
}

/** Link of a new invitation as a QR code and as text; shown once. */
export function InvitationLink({ invited, onDone }: Props): ReactNode {
  const all = useTexts();
  const texts = all.people;
  const [copied, setCopied] = useState(false);
  const { name, role, for_machine } = invited.invitation;
  return (
    <section aria-labelledby="invited" className="people-link">
      <h3 id="invited">
        {name} · {all.signIn.role[role]}
      </h3>
      {!invited.is_reachable && <Alert title={texts.here} />}
      {!for_machine && (
        <figure>
          <img src={`data:image/svg+xml,${encodeURIComponent(invited.qr_svg)}`} alt={texts.scan} />
          <figcaption>{texts.scan}</figcaption>
        </figure>
      )}
      <p>{texts.shown}</p>
      <code data-testid="invitation-link">{invited.link}</code>
      <div className="people-row">
        <Button
          size="lg"
          variant="default"
          onClick={() => {
            // Without TLS there may be no clipboard; the text above can be selected instead.
            void (navigator.clipboard as Clipboard | undefined)?.writeText(invited.link).then(() => {
              setCopied(true);
            });
          }}
        >
          {copied ? texts.copied : texts.copy}
        </Button>
        <Button size="lg" onClick={onDone}>
          {texts.done}
        </Button>
      </div>
    </section>
  );
}
