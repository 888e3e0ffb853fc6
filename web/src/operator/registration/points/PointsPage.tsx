import type { ReactNode } from "react";
import { QueryStatus } from "../../../rest/QueryStatus";
import { useActiveProcedures } from "../useActiveProcedures";
import { PointsBegin } from "./PointsBegin";
import { PointsWork } from "./PointsWork";

/** Registration with landmarks. */
export function PointsPage(): ReactNode {
  const running = useActiveProcedures();
  return (
    <>
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
