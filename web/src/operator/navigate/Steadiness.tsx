import { useRef, type ReactNode } from "react";
import { usePainter } from "../../live/LiveContext";
import { formatNumber } from "../../live/rounding";
import { setText } from "../../panes/setText";
import { useTexts } from "../../texts/TextsContext";

/** Smoothing and delay of the numbers, and when markers were last seen. */
export function Steadiness(): ReactNode {
  const texts = useTexts();
  const lag = useRef<HTMLElement>(null);
  const unseen = useRef<HTMLElement>(null);
  usePainter(({ newest, numbers }) => {
    const reading = numbers.live ? numbers.reading : null;
    setText(
      lag.current,
      reading === null
        ? "—"
        : reading.lagMs > 0
          ? `${texts.navigate.steadied} ${formatNumber(reading.lagMs, 0)} ms`
          : texts.navigate.notSteadied,
    );
    const markers = newest?.snapshot?.markers ?? [];
    setText(
      unseen.current,
      markers
        .map(({ name, sighting, unseen_s }) => {
          if (sighting.kind === "seen") return `${name} ✓`;
          return `${name} ▲ ${unseen_s === null ? texts.navigate.neverSeen : `${formatNumber(unseen_s, 1)} s`}`;
        })
        .join(" · ") || "—",
    );
  });
  return (
    <section className="card steadiness" data-testid="steadiness">
      <dl>
        <div>
          <dt>{texts.navigate.lag}</dt>
          <dd ref={lag} />
        </div>
        <div>
          <dt>{texts.navigate.markers}</dt>
          <dd ref={unseen} />
        </div>
      </dl>
    </section>
  );
}
