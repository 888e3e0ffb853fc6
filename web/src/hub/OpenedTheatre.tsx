import type { ReactNode } from "react";
import { AlarmsShown } from "../alarms/AlarmBand";
import { SignedIn } from "../app/SignedIn";
import { AfterFirstMessage } from "../live/AfterFirstMessage";
import { LiveProvider } from "../live/LiveContext";
import { MarkingProvider } from "../marks/MarkingContext";
import { MarksTools } from "../marks/MarksTools";
import { LoadingNumbers } from "../panes/LoadingNumbers";
import { NumbersPane } from "../panes/NumbersPane";
import { VideoPane } from "../panes/VideoPane";
import { RoomProvider } from "../room/RoomContext";
import { AgesStrip } from "../supervisor/Ages";
import { HoldPanel } from "../supervisor/HoldPanel";
import { Signables } from "../supervisor/Signables";
import { useTexts } from "../texts/TextsContext";
import { ThemeButton } from "../theme/ThemeButton";
import { theatresAt } from "./heard";
import { HubNote } from "./HubNote";
import { TheatreSession, useTheatreSession } from "./TheatreSession";
import { useTheatres } from "./useTheatres";

/** One theatre through the hub, by the panes of the theatre's own pages; covered by this page's own clock. */
export function OpenedTheatre({ name }: { name: string }): ReactNode {
  const all = useTexts();
  const texts = all.hub;
  const session = useTheatreSession();
  const isIn = session.data !== null;
  return (
    <LiveProvider>
      <InRoom isIn={isIn}>
        <div className="supervisor hub">
          <header className="supervisor-top">
            <h1>
              {name} <small>{all.product}</small>
            </h1>
            <p className="notice">
              {all.notice}. <span className="notice-more">{texts.through}</span>
            </p>
            <a className="big-link" href={`/${location.search}`}>
              {texts.all}
            </a>
            <ThemeButton />
            <SignedIn />
          </header>
          <Contact name={name} />
          <AlarmsShown />
          <main className="opened">
            <div className="opened-numbers">
              <AgesStrip />
              <AfterFirstMessage loading={<LoadingNumbers />}>
                <NumbersPane />
              </AfterFirstMessage>
            </div>
            {isIn ? (
              <MarkingProvider>
                <div className="opened-video">
                  <VideoPane />
                  <MarksTools />
                </div>
              </MarkingProvider>
            ) : (
              <VideoPane />
            )}
            <div className="opened-acts">
              <TheatreSession theatre={name} query={session} />
              {isIn && (
                <>
                  <HoldPanel />
                  <Signables />
                </>
              )}
            </div>
          </main>
        </div>
      </InRoom>
    </LiveProvider>
  );
}

/** The theatre's room, for whoever has a session there. */
function InRoom({ isIn, children }: { isIn: boolean; children: ReactNode }): ReactNode {
  return isIn ? <RoomProvider view="supervisor">{children}</RoomProvider> : children;
}

/** Whether theatre, NATS server and hub are heard; nothing while they are. */
function Contact({ name }: { name: string }): ReactNode {
  const texts = useTexts().hub;
  const { heard, problem, nowMs } = useTheatres();
  const theatre = heard === null ? undefined : theatresAt(heard, nowMs).find((one) => one.name === name);
  const presence = theatre?.presence;
  return (
    <>
      <HubNote heard={heard} problem={problem} nowMs={nowMs} />
      {presence !== undefined && presence !== "live" && (
        <p className="hub-note" role="alert" data-testid="theatre-presence" data-presence={presence}>
          ▲ {name}: {texts.covered[presence]}
        </p>
      )}
    </>
  );
}
