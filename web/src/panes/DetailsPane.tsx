import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { shownNumber } from "../live/rounding";
import { useWords } from "../words/WordsContext";

/** Times and counts for those who want them; closed for those who drill. */
export function DetailsPane(): ReactNode {
  const words = useWords();
  const { view, dashboard } = useLive();
  const { newest } = view;
  const d = words.details;
  const facts: [string, string][] = [
    [d.images, String(newest?.source.images ?? "—")],
    [d.skipped, String(newest?.snapshot?.skipped_images ?? newest?.source.skipped_images ?? "—")],
    [d.restarts, String(newest?.process.restarts ?? "—")],
    [d.size, newest?.snapshot ? `${newest.snapshot.width_px} × ${newest.snapshot.height_px} px` : "—"],
    [d.version, dashboard?.version ?? "—"],
  ];
  const stages = Object.entries(newest?.snapshot?.stage_ms ?? {});
  return (
    <details className="details">
      <summary>{d.title}</summary>
      <dl>
        {facts.map(([name, value]) => (
          <div key={name}>
            <dt>{name}</dt>
            <dd>{value}</dd>
          </div>
        ))}
        {stages.map(([stage, ms]) => (
          <div key={`stage ${stage}`}>
            <dt>
              {d.stage} {stage}
            </dt>
            <dd>{shownNumber(ms)} ms</dd>
          </div>
        ))}
      </dl>
      {dashboard?.cameras.map(({ name, video_path }) => (
        <p key={name}>
          <a href={video_path}>
            {d.plainVideo}: {name}
          </a>
        </p>
      ))}
    </details>
  );
}
