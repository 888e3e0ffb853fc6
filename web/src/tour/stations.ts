// Stations of the tour through the rehearsal, in order. Each shows a part of a page; the tour changes nothing else.
import type { Role } from "../app/session";

export type StationName =
  | "video"
  | "alarms"
  | "steps"
  | "camera"
  | "tool"
  | "plan"
  | "register"
  | "check"
  | "figures"
  | "theatre"
  | "supervisor"
  | "report";

export interface Station {
  name: StationName;
  path: string;
  /** Selector of the part that is outlined. */
  part: string;
}

const HEAD = ".step-head";

export const STATIONS: readonly Station[] = [
  { name: "video", path: "/operator/navigate", part: ".pane-video" },
  { name: "alarms", path: "/operator/navigate", part: ".alarms" },
  { name: "steps", path: "/operator/case", part: ".rail" },
  { name: "camera", path: "/operator/camera", part: HEAD },
  { name: "tool", path: "/operator/tool", part: HEAD },
  { name: "plan", path: "/operator/plan", part: HEAD },
  { name: "register", path: "/operator/register", part: HEAD },
  { name: "check", path: "/operator/check", part: HEAD },
  { name: "figures", path: "/operator/navigate", part: ".pane-numbers" },
  { name: "theatre", path: "/theatre", part: ".pane-video" },
  { name: "supervisor", path: "/supervisor", part: ".hold" },
  { name: "report", path: "/operator/report", part: HEAD },
];

/** Whether the tour may run: only with the simulated theatre, and for the role that may open all of its pages. */
export function mayTour(source: string | null, role: Role): boolean {
  return source === "rehearsal" && role === "operator";
}
