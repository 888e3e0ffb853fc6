import type { ReactNode } from "react";
import { AlarmBand } from "../alarms/AlarmBand";
import { ConfirmRestart } from "../app/ConfirmRestart";
import { AlertBand } from "../panes/AlertBand";
import { Announcer } from "../panes/Announcer";
import { DetailsPane } from "../panes/DetailsPane";
import { Header } from "../panes/Header";
import { MarkersPane } from "../panes/MarkersPane";
import { NumbersPane } from "../panes/NumbersPane";
import { ScenePane } from "../panes/ScenePane";
import { VideoPane } from "../panes/VideoPane";
import { useWords } from "../words/WordsContext";

/** The theatre's view: video first, numbers and 3-D beside it. */
export function TheatreView(): ReactNode {
  const words = useWords();
  return (
    <div className="page">
      <a className="skip" href="#numbers">
        {words.skip}
      </a>
      <Header />
      <AlarmBand />
      <ConfirmRestart />
      <AlertBand />
      <main className="panes">
        <div className="column">
          <VideoPane />
          <MarkersPane />
        </div>
        <div className="column">
          <NumbersPane />
          <ScenePane />
        </div>
      </main>
      <DetailsPane />
      <Announcer />
    </div>
  );
}
