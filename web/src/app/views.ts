// Which view is shown: the one in the address, else the one of the role; never one that the role may not have.
import type { Role } from "./session";

export type ViewName = "theatre" | "operator" | "supervisor";

export const PATHS: Record<ViewName, string> = {
  theatre: "/theatre",
  operator: "/operator",
  supervisor: "/supervisor",
};

const OPEN_TO: Record<Role, readonly ViewName[]> = {
  operator: ["operator", "theatre", "supervisor"],
  supervisor: ["supervisor", "theatre"],
  viewer: ["theatre"],
  screen: ["theatre"],
};

/** The views that a role may choose from, its own one first. */
export function viewsOf(role: Role): readonly ViewName[] {
  return OPEN_TO[role];
}

/** The theatre's view at `/`, because that is what a screen without hands shall show. */
export function viewAt(path: string, role: Role): ViewName {
  const named = viewsOf(role).find((view) => path === PATHS[view] || path.startsWith(`${PATHS[view]}/`));
  return named ?? "theatre";
}
