import type { CameraModeMessage, CameraStatusMessage } from "../live/messages";
import { formatNumber } from "../live/rounding";
import type { Texts } from "../texts/catalogue";

/** Mode granted by the camera's driver, and the clock of its images; empty without a camera. */
export function cameraFacts(camera: CameraStatusMessage | null, texts: Texts): [string, string, string][] {
  if (camera === null) return [];
  const d = texts.details;
  const facts: [string, string, string][] = [[d.clock, texts.imageClock[camera.clock], "image-clock"]];
  if (camera.granted !== null) facts.push([d.mode, modeText(camera.granted), "camera-mode"]);
  return facts;
}

function modeText({ fourcc, width_px, height_px, rate_hz }: CameraModeMessage): string {
  const size = `${String(width_px)} × ${String(height_px)} px`;
  const rate = rate_hz > 0 ? `${formatNumber(rate_hz)} Hz` : "";
  return [size, fourcc, rate].filter((part) => part !== "").join(", ");
}
