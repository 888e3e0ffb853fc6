import type { ReactNode } from "react";
import { useProcedure } from "../app/procedure";
import { useLive } from "../live/LiveContext";
import { Fact } from "../panes/Fact";
import { serverStateOf } from "../panes/serverState";
import { useTexts } from "../texts/TextsContext";
import { channelName } from "./channelName";
import { checkText, registrationText, type StatusText } from "./statusTexts";

/** Good states are not shown as good beside a picture or figures that are too old. */
function dimmed(status: StatusText | null, isOfNow: boolean): StatusText | null {
  return status?.mood === "good" && !isOfNow ? { ...status, mood: "waiting" } : status;
}

/** Case, level and side; the registration's method; ages of registration and check. */
export function NavigationStatus(): ReactNode {
  const texts = useTexts();
  const { view } = useLive();
  const { linkState, snapshot, isOfNow } = serverStateOf(view);
  const isConnected = linkState === "open";
  const procedure = useProcedure();
  const known = isConnected ? procedure.data : null;
  const t = texts.theatre;
  const registration = dimmed(registrationText(snapshot, known, t), isOfNow);
  const check = dimmed(checkText(snapshot, known, t), isOfNow);
  const unknown = isConnected && procedure.rejection !== null ? t.unknown : "—";
  const unseen = isConnected ? t.unknown : "—";
  const channel =
    snapshot === null
      ? unseen
      : snapshot.channel_name === null
        ? t.noChannel
        : channelName(snapshot.channel_name, texts);
  return (
    <dl className="facts facts-navigated" aria-label={t.facts}>
      <Fact
        name={t.case}
        value={known === null ? unknown : (known.case_name ?? t.noCase)}
        testid="case-name"
      />
      <Fact name={t.channel} value={channel} testid="channel-name" />
      <Fact name={t.registration} {...(registration ?? { value: unseen })} testid="registered-by" />
      {check !== null && <Fact name={t.check} {...check} testid="checked" />}
    </dl>
  );
}
