// When a video frame was captured, on the page's clock.
import type { FrameTime } from "./messages";

/** A camera that needs longer from capture to presentation has another clock: its time is not believed. */
const MAX_PIPELINE_MS = 1000;

/** The part of `VideoFrameCallbackMetadata` that says when. */
export interface FrameTimes {
  presentationTime: number;
  captureTime?: number;
}

/**
 * The capture time where the browser gives a plausible one, else the time of presentation, which is later by
 * exposure and processing. The frame is drawn after its times were read, so it is never older than they say.
 */
export function frameTime({ presentationTime, captureTime }: FrameTimes): FrameTime {
  const pipelineMs = captureTime === undefined ? NaN : presentationTime - captureTime;
  return captureTime !== undefined && pipelineMs >= 0 && pipelineMs <= MAX_PIPELINE_MS
    ? { captured_ms: captureTime, clock: "capture" }
    : { captured_ms: presentationTime, clock: "presentation" };
}
