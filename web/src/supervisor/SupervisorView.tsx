import type { ReactNode } from "react";
import { TheatreView } from "../theatre/TheatreView";

/** The supervisor's view: what the theatre sees, its plan and its log. */
export function SupervisorView(): ReactNode {
  return <TheatreView />;
}
