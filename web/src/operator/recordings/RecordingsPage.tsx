import type { ReactNode } from "react";
import { Recordings } from "../../recording/Recordings";

/** Recordings of the open case. */
export function RecordingsPage(): ReactNode {
  return <Recordings mayChange />;
}
