// The measured latency in one line.
import { formatNumber } from "../live/rounding";
import type { Latency } from "../rest/useLatency";
import { interpolate } from "../texts/interpolate";
import type { LatencyTexts } from "../texts/latency/en";

export function latencyText({ result }: Latency, texts: LatencyTexts): string {
  if (result === null) return texts.notMeasured;
  return interpolate(texts.measured, {
    median: formatNumber(result.report.median_ms, 0),
    p99: formatNumber(result.report.p99_ms, 0),
    day: result.at.slice(0, 10),
  });
}
