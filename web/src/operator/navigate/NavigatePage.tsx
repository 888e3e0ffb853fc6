import type { ReactNode } from "react";
import { AfterFirstMessage } from "../../live/AfterFirstMessage";
import { LoadingNumbers } from "../../panes/LoadingNumbers";
import { NumbersPane } from "../../panes/NumbersPane";
import { VideoPane } from "../../panes/VideoPane";
import { useProcedure } from "../../app/procedure";
import { RehearsalStrip } from "../registration/RehearsalStrip";
import { ChannelSwitch } from "./ChannelSwitch";
import { Gates } from "./Gates";
import { MovementWarning } from "./MovementWarning";
import { Steadiness } from "./Steadiness";

/** What the operator watches while the surgeon drills: picture, numbers, gates, and the channel in work. */
export function NavigatePage(): ReactNode {
  const { data } = useProcedure();
  return (
    <div className="registration" data-testid="navigate" data-may={data?.may_navigate}>
      <RehearsalStrip scenes={["operation"]} />
      <MovementWarning />
      <Gates />
      <div className="work navigate">
        <div className="work-main">
          <VideoPane />
          <Steadiness />
        </div>
        <div className="work-side">
          <AfterFirstMessage loading={<LoadingNumbers />}>
            <NumbersPane />
          </AfterFirstMessage>
          <ChannelSwitch />
        </div>
      </div>
    </div>
  );
}
