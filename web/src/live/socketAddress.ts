import { throughHub } from "../hub/openedTheatre";

/** Address of a WebSocket of this server, or of a theatre through the hub; encrypted if the page is. */
export function socketAddress(path: string): string {
  return `${location.protocol === "https:" ? "wss:" : "ws:"}//${location.host}${throughHub(path)}`;
}
