import type { ReactNode } from "react";
import { AlarmBand, AlarmsShown } from "../alarms/AlarmBand";
import { useSession, type Role } from "../app/session";
import { ConfirmRestart } from "../app/ConfirmRestart";
import { CutsProvider } from "../cuts/CutsContext";
import { AfterFirstMessage } from "../live/AfterFirstMessage";
import { LoadingNumbers } from "../panes/LoadingNumbers";
import { NumbersPane } from "../panes/NumbersPane";
import { VideoPane } from "../panes/VideoPane";
import { useTexts } from "../texts/TextsContext";
import { FiguresMain } from "./FiguresMain";
import { LayoutBar } from "./layouts/LayoutBar";
import { isFiguresScreen, LARGE_FIGURES } from "./layouts/layout";
import { useIsWide } from "./layouts/useIsWide";
import { useLayouts } from "./layouts/useLayouts";
import { Tiles } from "./Tiles";
import { TheatreTop } from "./TheatreTop";

const ANSWERING: ReadonlySet<Role> = new Set<Role>(["operator", "screen"]);

/** The theatre view: everything needed while drilling, on one screen, readable from 3 m. */
export function TheatreView(): ReactNode {
  const texts = useTexts();
  const { session } = useSession();
  // Alarms are acknowledged on a theatre screen; other viewers only see them.
  const answersAlarms = session.state === "in" && ANSWERING.has(session.who.role);
  const isFigures = isFiguresScreen(location.search);
  const isWide = useIsWide();
  const layouts = useLayouts(isWide && !isFigures);
  // A smaller screen has one layout.
  const layout = isWide ? layouts.layout : "overview";
  return (
    <div className="theatre" data-layout={isFigures ? "figures" : layout} data-testid="theatre">
      <a className="skip" href="#numbers">
        {texts.skip}
      </a>
      <TheatreTop layouts={layouts} />
      {answersAlarms ? <AlarmBand /> : <AlarmsShown />}
      {isFigures ? (
        <FiguresMain />
      ) : (
        <main className="theatre-main">
          <VideoPane />
          <AfterFirstMessage loading={<LoadingNumbers />}>
            <NumbersPane large={LARGE_FIGURES[layout]} over={<ConfirmRestart />} />
          </AfterFirstMessage>
          <CutsProvider>
            <Tiles layout={layout} isWide={isWide} />
          </CutsProvider>
          {isWide && <LayoutBar layouts={layouts} />}
        </main>
      )}
    </div>
  );
}
