import type { ReactNode } from "react";
import { shownNumber } from "../../live/rounding";
import { filled } from "../../words/filled";
import { useWords } from "../../words/WordsContext";
import { Measure } from "../parts/Measure";
import { shownTime } from "../parts/shown";
import { STAGES, type Result } from "./result";

/** What was measured, its stages, and what it cannot tell. */
export function LatencyReport({ result }: { result: Result }): ReactNode {
  const all = useWords();
  const words = all.latency;
  const { report, screen } = result;
  return (
    <>
      <p className="soft">
        {shownTime(result.at, all.language)} · {result.made_by} · {result.camera} · {result.width_px} ×{" "}
        {result.height_px} px · {shownNumber(result.rate_hz)} {words.perSecond}
      </p>
      <dl className="measures">
        <Measure
          name={words.median}
          value={report.median_ms}
          unit="ms"
          decimals={0}
          testId="latency-median"
        />
        <Measure name={words.p99} value={report.p99_ms} unit="ms" decimals={0} testId="latency-p99" />
        {STAGES.map((stage) => (
          <Measure
            key={stage}
            name={words.stage[stage]}
            value={report.stage_ms[stage] ?? null}
            unit="ms"
            decimals={0}
            testId={`latency-${stage.replaceAll(" ", "-")}`}
          />
        ))}
      </dl>
      <p className="soft">
        {filled(words.resolution, {
          samples: report.samples,
          images: report.images,
          skipped: report.skipped_images,
          period: shownNumber(report.image_period_ms, 0),
          late: shownNumber(report.late_on_average_ms, 0),
          screen: shownNumber(screen.period_ms, 0),
          clocks: shownNumber(report.clock_error_ms),
        })}
      </p>
    </>
  );
}
