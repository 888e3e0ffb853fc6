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
  camera: [],
};

/** Where a device sends its camera's images. Loaded anew, never gone to: only this address may ask for a camera. */
export const CAMERA_PATH = "/camera";
const MAY_SEND: ReadonlySet<Role> = new Set<Role>(["operator", "camera"]);

/** The views that a role may choose from, its own one first. */
export function viewsOf(role: Role): readonly ViewName[] {
  return OPEN_TO[role];
}

/** Where somebody of this role begins. */
export function homeOf(role: Role): string {
  const first = viewsOf(role)[0];
  return first === undefined ? CAMERA_PATH : PATHS[first];
}

/** Whether this device shall be the camera: where it may, and where it is asked to or may nothing else. */
export function isCameraAt(path: string, role: Role): boolean {
  return MAY_SEND.has(role) && (path === CAMERA_PATH || viewsOf(role).length === 0);
}

/** The theatre's view at `/`, because that is what a screen without hands shall show. */
export function viewAt(path: string, role: Role): ViewName {
  const named = viewsOf(role).find((view) => path === PATHS[view] || path.startsWith(`${PATHS[view]}/`));
  return named ?? "theatre";
}
