import type { ReactNode } from "react";
import { AlarmsShown } from "../alarms/AlarmBand";
import { SignedIn } from "../app/SignedIn";
import { ViewSwitch } from "../app/ViewSwitch";
import { CutsProvider } from "../cuts/CutsContext";
import { AfterFirstMessage } from "../live/AfterFirstMessage";
import { HelpButton } from "../help/HelpButton";
import { PictureSize } from "../live/PictureSize";
import { MarkingProvider } from "../marks/MarkingContext";
import { MarksTools } from "../marks/MarksTools";
import { AuditLog } from "../operator/people/AuditLog";
import { LoadingNumbers } from "../panes/LoadingNumbers";
import { NumbersPane } from "../panes/NumbersPane";
import { VideoPane } from "../panes/VideoPane";
import { Recordings } from "../recording/Recordings";
import { RecordingState } from "../recording/RecordingState";
import { ViewerLooks, Viewers } from "../room/Viewers";
import { LayoutBar } from "../theatre/layouts/LayoutBar";
import { useIsWide, WIDE_BOARD } from "../theatre/layouts/useIsWide";
import { useLayouts } from "../theatre/layouts/useLayouts";
import { Tiles } from "../theatre/Tiles";
import { ThemeButton } from "../theme/ThemeButton";
import { useTexts } from "../texts/TextsContext";
import { isLoopback } from "../live/loopback";
import { AgesStrip } from "./Ages";
import { Fold } from "./Fold";
import { HoldPanel } from "./HoldPanel";
import { LogPanel } from "./LogPanel";
import { Signables } from "./Signables";
import { StepsShown } from "./StepsShown";

/** View of the supervisor: observes, points, signs, asks to hold. It controls nothing. */
export function SupervisorView(): ReactNode {
  const texts = useTexts();
  const own = texts.supervisor;
  return (
    <div className="supervisor">
      <a className="skip" href="#video">
        {own.skip}
      </a>
      <div className="first-screen">
        <header className="supervisor-top">
          <h1>
            {texts.product} <small>{own.title}</small>
          </h1>
          <p className="notice">
            {texts.notice}. <span className="notice-more">{own.nothingMoves}</span>
          </p>
          <RecordingState />
          <ViewSwitch />
          <Viewers />
          <ThemeButton />
          <HelpButton place="supervisor" />
          <SignedIn />
        </header>
        <AlarmsShown />
        <Board />
      </div>
      <section className="supervisor-folds" aria-label={texts.theatre.more}>
        <Fold id="steps" title={own.steps.title} open>
          <StepsShown />
        </Fold>
        <Fold id="looks" title={texts.room.what}>
          <ViewerLooks />
        </Fold>
        <Fold id="recordings" title={texts.operator.page.recordings}>
          <Recordings mayChange={false} />
        </Fold>
        <Fold id="log" title={own.log.title}>
          <LogPanel />
        </Fold>
        <Fold id="audit" title={own.audit}>
          <AuditLog />
        </Fold>
      </section>
    </div>
  );
}

/** Figures, video and cuts: on a laptop in the layouts of the theatre, on a smaller screen with one cut. */
function Board(): ReactNode {
  const isWide = useIsWide(WIDE_BOARD);
  const layouts = useLayouts(isWide);
  const layout = isWide ? layouts.layout : "overview";
  return (
    <main className="board" data-board-layout={isWide ? layout : undefined}>
      <MarkingProvider>
        <AfterFirstMessage loading={<LoadingNumbers />}>
          <NumbersPane />
        </AfterFirstMessage>
        <MarksTools />
        <VideoPane />
        <div className="decisions">
          <HoldPanel />
          <Signables />
        </div>
        <CutsProvider ctOnRequest={!isLoopback(location.hostname)}>
          <Tiles layout={layout} isWide={isWide} />
        </CutsProvider>
        <div className="board-foot">
          <AgesStrip />
          <PictureSize />
          {isWide && <LayoutBar layouts={layouts} />}
        </div>
      </MarkingProvider>
    </main>
  );
}
