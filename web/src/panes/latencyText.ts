// The measured latency in one line; omitted if it was measured with other images.
import { formatNumber } from "../live/rounding";
import type { Latency } from "../rest/useLatency";
import { interpolate } from "../texts/interpolate";
import type { LatencyTexts } from "../texts/latency/en";

export function latencyText({ result, applies }: Latency, texts: LatencyTexts): string {
  if (result === null) return texts.notMeasured;
  if (!applies) return otherImagesText(result, texts);
  return interpolate(texts.measured, {
    median: formatNumber(result.report.median_ms, 0),
    p99: formatNumber(result.report.p99_ms, 0),
    day: result.at.slice(0, 10),
  });
}

/** Size and rate of the measurement, if they differ from the current ones. */
export function otherImagesText(result: NonNullable<Latency["result"]>, texts: LatencyTexts): string {
  return interpolate(texts.otherImages, {
    size: `${String(result.width_px)} × ${String(result.height_px)} px`,
    rate: formatNumber(result.rate_hz, 0),
  });
}
