import type { ReactNode } from "react";
import { useLive } from "../../live/LiveContext";
import { formatNumber } from "../../live/rounding";
import { cameraFacts } from "../../panes/cameraFacts";
import { searchTimeMs } from "../../panes/searchTime";
import { problemsOf } from "../../panes/problems";
import { languageOf, textOf } from "../../texts/text";
import { useTexts } from "../../texts/TextsContext";
import { sentence } from "../parts/format";
import { Card } from "../parts/Card";

/** Current images of the camera: source, size, rate, age. */
export function CameraTest(): ReactNode {
  const texts = useTexts();
  const { view, dashboard } = useLive();
  const { newest, video } = view;
  const noAge = view.firstMessage === "awaited" ? "—" : texts.video.none;
  const snapshot = newest?.snapshot ?? null;
  const searchMs = snapshot === null ? null : searchTimeMs(snapshot.stage_ms);
  const rateHz = newest?.source.rate_hz ?? null;
  const facts: (readonly [string, string, (string | undefined)?])[] = [
    [texts.header.source, newest?.source.name ?? "—"],
    [texts.header.camera, newest === null ? "—" : texts.cameraState[newest.source.state]],
    [
      texts.details.size,
      snapshot === null ? "—" : `${String(snapshot.width_px)} × ${String(snapshot.height_px)} px`,
    ],
    ...cameraFacts(newest?.source.camera ?? null, texts).map(([name, value]) => [name, value] as const),
    [texts.header.rate, rateHz === null ? "—" : `${formatNumber(rateHz)} Hz`],
    [
      texts.camera.age,
      video.live ? `${formatNumber(video.ageMs, 0)} ms` : noAge,
      dashboard === null
        ? undefined
        : `${texts.case.measure.max} ${formatNumber(dashboard.limits.video_stale_after_ms, 0)} ms`,
    ],
    [texts.camera.searchTime, searchMs === null ? "—" : `${formatNumber(searchMs)} ms`],
    [texts.details.skipped, newest === null ? "—" : String(newest.source.skipped_images)],
    [
      texts.camera.calibrated,
      snapshot === null ? "—" : snapshot.camera_calibrated ? texts.camera.yes : texts.camera.no,
    ],
  ];
  return (
    <Card title={texts.camera.testTitle} testId="camera-test">
      <dl className="test-facts">
        {facts.map(([name, value, limit]) => (
          <div key={name}>
            <dt>{name}</dt>
            <dd>
              {value} {limit !== undefined && <span className="measure-limit">{limit}</span>}
            </dd>
          </div>
        ))}
      </dl>
      {problemsOf(view).map((problem) => (
        <p key={problem.code} className="bad" role="alert">
          ▲{" "}
          <span lang={languageOf(problem, texts)}>
            {sentence(textOf(problem.message, texts))} {textOf(problem.remedy, texts)}
          </span>
        </p>
      ))}
      {snapshot === null && problemsOf(view).length === 0 && <p className="soft">{texts.camera.waiting}</p>}
    </Card>
  );
}
