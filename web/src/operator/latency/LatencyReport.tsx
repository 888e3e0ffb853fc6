import type { ReactNode } from "react";
import { formatNumber } from "../../live/rounding";
import { interpolate } from "../../texts/interpolate";
import { useTexts } from "../../texts/TextsContext";
import { Measure } from "../parts/Measure";
import { formatTime } from "../parts/format";
import { STAGES, type Result } from "./result";

/** The measured latency, its stages and its resolution. */
export function LatencyReport({ result }: { result: Result }): ReactNode {
  const all = useTexts();
  const texts = all.latency;
  const { report, screen } = result;
  return (
    <>
      <p className="soft">
        {formatTime(result.at, all.language)} · {result.made_by} · {result.camera} · {result.width_px} ×{" "}
        {result.height_px} px · {formatNumber(result.rate_hz)} {texts.perSecond}
      </p>
      <dl className="measures">
        <Measure
          name={texts.median}
          value={report.median_ms}
          unit="ms"
          decimals={0}
          testId="latency-median"
        />
        <Measure name={texts.p99} value={report.p99_ms} unit="ms" decimals={0} testId="latency-p99" />
        {STAGES.map((stage) => (
          <Measure
            key={stage}
            name={texts.stage[stage]}
            value={report.stage_ms[stage] ?? null}
            unit="ms"
            decimals={0}
            testId={`latency-${stage.replaceAll(" ", "-")}`}
          />
        ))}
      </dl>
      <p className="soft">
        {interpolate(texts.resolution, {
          samples: report.samples,
          images: report.images,
          skipped: report.skipped_images,
          period: formatNumber(report.image_period_ms, 0),
          late: formatNumber(report.late_on_average_ms, 0),
          screen: formatNumber(screen.period_ms, 0),
          clocks: formatNumber(report.clock_error_ms),
        })}
      </p>
    </>
  );
}
