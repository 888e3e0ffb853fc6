import { useRef, type ReactNode } from "react";
import { SignedIn } from "../app/SignedIn";
import { ViewSwitch } from "../app/ViewSwitch";
import { GuidingSoundSettings } from "../guidance/GuidingSoundSettings";
import { HelpButton } from "../help/HelpButton";
import { PictureSize } from "../live/PictureSize";
import { DetailsPane } from "../panes/DetailsPane";
import { MarkersPane } from "../panes/MarkersPane";
import { RecordingState } from "../recording/RecordingState";
import { ViewerLooks } from "../room/Viewers";
import { useTexts } from "../texts/TextsContext";
import { ThemeButton } from "../theme/ThemeButton";
import { LayoutSettings } from "./layouts/LayoutSettings";
import type { Layouts } from "./layouts/useLayouts";

/** Scores, times and counts, collapsed by default. */
export function MoreDetails({ layouts }: { layouts: Layouts }): ReactNode {
  const { theatre: texts, room } = useTexts();
  const details = useRef<HTMLDetailsElement>(null);
  return (
    <details
      className="more"
      ref={details}
      onKeyDown={(event) => {
        if (event.key !== "Escape" || !details.current?.open) return;
        details.current.open = false;
        details.current.querySelector("summary")?.focus();
      }}
    >
      <summary data-testid="more">{texts.more}</summary>
      <div className="more-sheet" tabIndex={0} role="region" aria-label={texts.more}>
        <div className="more-tools">
          <ViewSwitch />
          <PictureSize />
          <ThemeButton />
          <HelpButton place="theatre" />
          <RecordingState testId="recording-more" />
          <SignedIn />
        </div>
        <section className="viewer-looks" aria-labelledby="looks-title">
          <h2 id="looks-title">{room.what}</h2>
          <ViewerLooks />
        </section>
        <LayoutSettings layouts={layouts} />
        <GuidingSoundSettings />
        <MarkersPane />
        <DetailsPane />
      </div>
    </details>
  );
}
