// Messages to the 3-D scene in its frame; `watch.js` receives them there.
import type { DrawingBudget } from "../live/budget";

export const VIEWS = ["behind", "channel", "camera"] as const;
export type ViewName = (typeof VIEWS)[number];

/** Moves the viewer's camera. */
export function sendView(frame: HTMLIFrameElement | null, view: ViewName): void {
  frame?.contentWindow?.postMessage({ kind: "coaxial-view", view }, location.origin);
}

/** Sets the shortest interval between two images. */
export function sendRate(frame: HTMLIFrameElement | null, { sceneIntervalMs }: DrawingBudget): void {
  const message = { kind: "coaxial-rate", min_interval_ms: sceneIntervalMs };
  frame?.contentWindow?.postMessage(message, location.origin);
}

/** Reduces the drawn pixels: the frame is made smaller and scaled up again. */
export function setSize(frame: HTMLIFrameElement | null, { sceneScale }: DrawingBudget): void {
  if (frame === null) return;
  const shown = `${100 * sceneScale}%`;
  frame.style.width = frame.style.height = shown;
  frame.style.transform = sceneScale === 1 ? "" : `scale(${1 / sceneScale})`;
}
