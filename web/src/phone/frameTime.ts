// Capture time of a video frame, on the page's clock.
import type { FrameTime } from "./messages";

/** A larger delay from capture to presentation means another clock; the capture time is then ignored. */
const MAX_PIPELINE_MS = 1000;

/** The timing fields of `VideoFrameCallbackMetadata`. */
export interface FrameTimes {
  presentationTime: number;
  captureTime?: number;
}

/**
 * Returns the capture time if it is plausible, else the presentation time, which is later by exposure and
 * processing. The frame is drawn after its times were read, so it is never older than stated.
 */
export function frameTime({ presentationTime, captureTime }: FrameTimes): FrameTime {
  const pipelineMs = captureTime === undefined ? NaN : presentationTime - captureTime;
  return captureTime !== undefined && pipelineMs >= 0 && pipelineMs <= MAX_PIPELINE_MS
    ? { captured_ms: captureTime, clock: "capture" }
    : { captured_ms: presentationTime, clock: "presentation" };
}
