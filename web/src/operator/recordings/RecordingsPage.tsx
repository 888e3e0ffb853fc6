import type { ReactNode } from "react";
import { Recordings } from "../../recording/Recordings";

/** What was recorded in the open case. */
export function RecordingsPage(): ReactNode {
  return <Recordings mayChange />;
}
