import type { ReactNode } from "react";
import { QueryStatus } from "../../../rest/QueryStatus";
import { RehearsalStrip } from "../RehearsalStrip";
import { TipRests } from "../TipRests";
import { useRunning } from "../useRunning";
import { PointsBegin } from "./PointsBegin";
import { PointsWork } from "./PointsWork";

/** Registration by points: the tip on landmarks of the plan. */
export function PointsPage(): ReactNode {
  const running = useRunning();
  return (
    <>
      <RehearsalStrip scenes={["landmarks"]}>{(told) => <TipRests told={told} />}</RehearsalStrip>
      {running.data === null && <QueryStatus query={running} />}
      {running.data !== null &&
        (running.data.points ? (
          <PointsWork onOver={running.refetch} />
        ) : (
          <PointsBegin onBegun={running.refetch} />
        ))}
    </>
  );
}
