// Chooses the view: from the address, else from the role; never a view that the role may not open.
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
  camera: [],
};

/** Address of the camera page. It is loaded as a document, since only this address may request a camera. */
export const CAMERA_PATH = "/camera";
const MAY_SEND: ReadonlySet<Role> = new Set<Role>(["operator", "camera"]);

/** Views that a role may open, its default first. */
export function viewsOf(role: Role): readonly ViewName[] {
  return OPEN_TO[role];
}

/** Default view of a role. */
export function homeOf(role: Role): string {
  const first = viewsOf(role)[0];
  return first === undefined ? CAMERA_PATH : PATHS[first];
}

/** Whether this device is used as a camera: requested by the address, or the only thing its role may do. */
export function isCameraAt(path: string, role: Role): boolean {
  return MAY_SEND.has(role) && (path === CAMERA_PATH || viewsOf(role).length === 0);
}

/** `/` shows the theatre view, so that a screen without input devices needs no path. */
export function viewAt(path: string, role: Role): ViewName {
  const named = viewsOf(role).find((view) => path === PATHS[view] || path.startsWith(`${PATHS[view]}/`));
  return named ?? "theatre";
}
