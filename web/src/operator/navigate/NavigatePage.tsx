import type { ReactNode } from "react";
import { ConfirmRestart } from "../../app/ConfirmRestart";
import { CutsProvider } from "../../cuts/CutsContext";
import { ChosenTile } from "../../cuts/CutTile";
import { AfterFirstMessage } from "../../live/AfterFirstMessage";
import { LoadingNumbers } from "../../panes/LoadingNumbers";
import { NumbersPane } from "../../panes/NumbersPane";
import { VideoPane } from "../../panes/VideoPane";
import { useProcedure } from "../../app/procedure";
import { SetupCheckNote } from "../SetupCheckNote";
import { RehearsalStrip } from "../registration/RehearsalStrip";
import { CertificateNote } from "./CertificateNote";
import { ChannelSwitch } from "./ChannelSwitch";
import { Gates } from "./Gates";
import { MovementWarning } from "./MovementWarning";
import { PlacedScrews } from "./PlacedScrews";
import { Steadiness } from "./Steadiness";

/** The operator's page during drilling: gates, numbers, picture, cuts and the active channel. */
export function NavigatePage(): ReactNode {
  const { data } = useProcedure();
  return (
    <div className="registration navigate" data-testid="navigate" data-may={data?.may_navigate}>
      <div className="navigate-first">
        <Gates />
        <div className="board">
          <AfterFirstMessage loading={<LoadingNumbers />}>
            <NumbersPane over={<ConfirmRestart />} />
          </AfterFirstMessage>
          <VideoPane />
          <CutsProvider>
            <ChosenTile />
          </CutsProvider>
        </div>
      </div>
      {/* Below the picture, which an alarm must not move: the band of alarms states the same. */}
      <MovementWarning />
      <SetupCheckNote />
      <div className="work">
        <Steadiness />
        <ChannelSwitch />
        <PlacedScrews />
      </div>
      <CertificateNote />
      <RehearsalStrip scenes={["operation"]} />
    </div>
  );
}
