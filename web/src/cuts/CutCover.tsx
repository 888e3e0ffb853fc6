import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { Cover } from "../panes/Cover";
import type { TheatreTexts } from "../texts/theatre/en";
import { textOf } from "../texts/text";
import { useTexts } from "../texts/TextsContext";
import { useCuts } from "./CutsContext";
import type { CutVerdict, NoVolume } from "./cutVerdict";

/** Covers a cut that is not valid, with the reason, as for figures and video. */
export function CutCover({ verdict }: { verdict: CutVerdict }): ReactNode {
  const texts = useTexts();
  const { view } = useLive();
  if (verdict.state !== "covered") return null;
  const t = texts.theatre.cuts;
  if (verdict.why === "late") return <Cover urgency="none" title={t.late} sentence={t.lateHint} />;
  if (verdict.why === "unread") {
    const unread = view.numbers.live ? null : view.numbers.unread;
    const title = unread === null ? texts.numbers.none : textOf(unread.headline.title, texts);
    return <Cover urgency="medium" title={title} sentence={t.unreadHint} />;
  }
  const { state, sentence } = texts.cause[verdict.why];
  return (
    <Cover urgency={verdict.why === "connecting" ? "none" : "medium"} title={state} sentence={sentence} />
  );
}

/** Why the CT is missing around the drill. */
export function NoVolumeNote({ volume }: { volume: NoVolume }): ReactNode {
  const t = useTexts().theatre.cuts;
  const { requestCt } = useCuts();
  return (
    <p className="cut-note" data-testid="cut-note">
      <b>{t.noCt}</b> {noVolumeText(volume, t)}
      {volume.state === "on_request" && (
        <button type="button" data-testid="request-ct" onClick={requestCt}>
          {t.requestCt}
        </button>
      )}
    </p>
  );
}

function noVolumeText(volume: NoVolume, t: TheatreTexts["cuts"]): string {
  if (volume.state === "rejected") return `${volume.problem.message}. ${volume.problem.remedy}`;
  if (volume.state !== "failed") return t.noVolume[volume.state];
  const why = volume.message === "" ? t.noAnswer : `${t.unreadable}: ${volume.message}.`;
  return `${why} ${t.requestedAgain}`;
}
