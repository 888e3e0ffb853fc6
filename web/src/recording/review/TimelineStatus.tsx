import type { ReactNode } from "react";
import { JobProgress } from "../../rest/JobProgress";
import { QueryStatus } from "../../rest/QueryStatus";
import type { TimelineState } from "./useTimeline";

/** What is shown until the timeline is loaded. */
export function TimelineStatus({ state }: { state: TimelineState }): ReactNode {
  return state.isIndexing ? <JobProgress followed={state.followed} /> : <QueryStatus query={state.query} />;
}
