// What the page says to the 3-D scene in its frame; `watch.js` hears it there.
import type { DrawingBudget } from "../live/budget";

export const VIEWS = ["behind", "channel", "camera"] as const;
export type ViewName = (typeof VIEWS)[number];

/** Put the viewer there. */
export function sendView(frame: HTMLIFrameElement | null, view: ViewName): void {
  frame?.contentWindow?.postMessage({ kind: "coaxial-view", view }, location.origin);
}

/** Draw no more often than this. */
export function sendRate(frame: HTMLIFrameElement | null, { sceneIntervalMs }: DrawingBudget): void {
  const message = { kind: "coaxial-rate", min_interval_ms: sceneIntervalMs };
  frame?.contentWindow?.postMessage(message, location.origin);
}

/** Draw in fewer pixels: the frame is made smaller, and shown as large as before. */
export function setSize(frame: HTMLIFrameElement | null, { sceneScale }: DrawingBudget): void {
  if (frame === null) return;
  const shown = `${100 * sceneScale}%`;
  frame.style.width = frame.style.height = shown;
  frame.style.transform = sceneScale === 1 ? "" : `scale(${1 / sceneScale})`;
}
