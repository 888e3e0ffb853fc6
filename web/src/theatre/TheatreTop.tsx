import type { ReactNode } from "react";
import { Brand } from "../panes/Brand";
import { RecordingState } from "../recording/RecordingState";
import { LiveStatus } from "../panes/LiveStatus";
import { Viewers } from "../room/Viewers";
import { MoreDetails } from "./MoreDetails";
import type { Layouts } from "./layouts/useLayouts";
import { NavigationStatus } from "./NavigationStatus";

/** Header of the theatre view: navigation status, viewers and live state. */
export function TheatreTop({ layouts }: { layouts: Layouts }): ReactNode {
  return (
    <header className="top">
      <Brand />
      <NavigationStatus />
      <Viewers />
      <RecordingState />
      <LiveStatus />
      <div className="top-tools">
        <MoreDetails layouts={layouts} />
      </div>
    </header>
  );
}
