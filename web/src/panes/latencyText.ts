// The measured latency in one line.
import { shownNumber } from "../live/rounding";
import type { Latency } from "../rest/useLatency";
import { filled } from "../words/filled";
import type { LatencyWords } from "../words/latency/en";

export function latencyText({ result }: Latency, words: LatencyWords): string {
  if (result === null) return words.notMeasured;
  return filled(words.measured, {
    median: shownNumber(result.report.median_ms, 0),
    p99: shownNumber(result.report.p99_ms, 0),
    day: result.at.slice(0, 10),
  });
}
