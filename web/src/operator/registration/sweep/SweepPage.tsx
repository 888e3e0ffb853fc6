import type { ReactNode } from "react";
import { QueryStatus } from "../../../rest/QueryStatus";
import { useActiveProcedures } from "../useActiveProcedures";
import { SweepBegin } from "./SweepBegin";
import { SweepWork } from "./SweepWork";

/** Refines a registration with a sweep of the tip over bare bone. */
export function SweepPage(): ReactNode {
  const running = useActiveProcedures();
  return (
    <>
      {running.data === null && <QueryStatus query={running} />}
      {running.data !== null &&
        (running.data.sweep ? (
          <SweepWork onOver={running.refetch} />
        ) : (
          <SweepBegin onBegun={running.refetch} />
        ))}
    </>
  );
}
