import type { ReactNode } from "react";
import { QueryStatus } from "../../../rest/QueryStatus";
import { RehearsalStrip } from "../RehearsalStrip";
import { TipContact } from "../TipContact";
import { useActiveProcedures } from "../useActiveProcedures";
import { PointsBegin } from "./PointsBegin";
import { PointsWork } from "./PointsWork";

/** Registration with landmarks. */
export function PointsPage(): ReactNode {
  const running = useActiveProcedures();
  return (
    <>
      <RehearsalStrip scenes={["landmarks"]}>
        {(rehearsal) => <TipContact rehearsal={rehearsal} />}
      </RehearsalStrip>
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
