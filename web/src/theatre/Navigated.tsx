import type { ReactNode } from "react";
import { useProcedure } from "../app/procedure";
import { useLive } from "../live/LiveContext";
import { Fact } from "../panes/Fact";
import { heardOf } from "../panes/heard";
import { useTexts } from "../texts/TextsContext";
import { checkText, registrationText, type Said } from "./standing";

/** What is well is not shown as well beside a picture and figures that are too old. */
function dimmed(said: Said | null, isOfNow: boolean): Said | null {
  return said?.mood === "good" && !isOfNow ? { ...said, mood: "waiting" } : said;
}

/** Which case, level and side are navigated, how it was registered, and how old that and its check are. */
export function Navigated(): ReactNode {
  const texts = useTexts();
  const { view } = useLive();
  const { linkState, snapshot, isOfNow } = heardOf(view);
  const isHeard = linkState === "open";
  const procedure = useProcedure();
  const known = isHeard ? procedure.data : null;
  const t = texts.theatre;
  const registration = dimmed(registrationText(snapshot, known, t), isOfNow);
  const check = dimmed(checkText(snapshot, known, t), isOfNow);
  const unknown = isHeard && procedure.rejection !== null ? t.unknown : "—";
  const unseen = isHeard ? t.unknown : "—";
  return (
    <dl className="facts facts-navigated" aria-label={t.facts}>
      <Fact
        name={t.case}
        value={known === null ? unknown : (known.case_name ?? t.noCase)}
        testid="case-name"
      />
      <Fact
        name={t.channel}
        value={snapshot === null ? unseen : (snapshot.channel_name ?? t.noChannel)}
        testid="channel-name"
      />
      <Fact name={t.registration} {...(registration ?? { value: unseen })} testid="registered-by" />
      {check !== null && <Fact name={t.check} {...check} testid="checked" />}
    </dl>
  );
}
