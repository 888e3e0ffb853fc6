import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { formatNumber } from "../live/rounding";
import { useCertificates } from "../rest/useCertificates";
import { useLatency } from "../rest/useLatency";
import { useTexts } from "../texts/TextsContext";
import { cameraFacts } from "./cameraFacts";
import { certificateText } from "./certificateText";
import { latencyText } from "./latencyText";
import { serverStateOf } from "./serverState";
import { Pane } from "./Pane";
import { searchTimeMs } from "./searchTime";

const NONE = "—";

/** Times and counts; values of a lost server are removed. */
export function DetailsPane(): ReactNode {
  const texts = useTexts();
  const { view, dashboard } = useLive();
  const { source, snapshot } = serverStateOf(view);
  const latency = useLatency().data;
  const certificates = useCertificates().data;
  const d = texts.details;
  const h = texts.header;
  const searchMs = snapshot === null ? null : searchTimeMs(snapshot.stage_ms);
  const facts: [string, string, string?][] = [
    [h.source, source?.name ?? NONE, "source"],
    [h.rate, source ? `${formatNumber(source.rate_hz, 0)} /s` : NONE],
    [h.searchTime, searchMs === null ? NONE : `${formatNumber(searchMs)} ms`, "search-time"],
    [
      texts.latency.lightToPage,
      latency === null ? NONE : latencyText(latency, texts.latency),
      "light-to-page",
    ],
    [
      texts.certificate.accuracy,
      certificates === null ? NONE : certificateText(certificates, texts.certificate),
      "certified",
    ],
    [d.images, String(source?.images ?? NONE)],
    [d.skipped, String(snapshot?.skipped_images ?? source?.skipped_images ?? NONE)],
    [d.restarts, source === null ? NONE : String(view.newest?.process.restarts ?? NONE)],
    [d.size, snapshot ? `${snapshot.width_px} × ${snapshot.height_px} px` : NONE],
    ...cameraFacts(source?.camera ?? null, texts),
    [d.version, dashboard?.version ?? NONE],
  ];
  const stages = Object.entries(snapshot?.stage_ms ?? {});
  return (
    <Pane id="details" title={d.title}>
      <dl className="details">
        {facts.map(([name, value, testid]) => (
          <div key={name} data-testid={testid}>
            <dt>{name}</dt>
            <dd>{value}</dd>
          </div>
        ))}
        {stages.map(([stage, ms]) => (
          <div key={`stage ${stage}`}>
            <dt>
              {d.stage} {stage}
            </dt>
            <dd>{formatNumber(ms)} ms</dd>
          </div>
        ))}
      </dl>
      {dashboard?.cameras.map(({ name, video_path }) => (
        <p key={name} className="details-video">
          <a href={video_path}>
            {d.plainVideo}: {name}
          </a>
        </p>
      ))}
      <p className="details-video">
        <a href="/docs/" target="_blank" rel="noreferrer">
          {d.guide}
        </a>
      </p>
    </Pane>
  );
}
