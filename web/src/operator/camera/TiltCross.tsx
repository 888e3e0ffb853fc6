import type { ReactNode } from "react";
import { formatFigure } from "../../live/rounding";
import { useTexts } from "../../texts/TextsContext";
import { armsOf, type Way } from "./tilts";

const LENGTH = 62;
const PLACES: Record<Way, { x: number; y: number; dx: number; dy: number }> = {
  up: { x: 100, y: 86, dx: 0, dy: -1 },
  down: { x: 100, y: 114, dx: 0, dy: 1 },
  left: { x: 86, y: 100, dx: -1, dy: 0 },
  right: { x: 114, y: 100, dx: 1, dy: 0 },
};

/** Tilt of the board to each side, relative to the required tilt. */
export function TiltCross({
  tiltDeg,
  wantedDeg,
}: {
  tiltDeg: readonly number[];
  wantedDeg: number;
}): ReactNode {
  const texts = useTexts().camera;
  const arms = armsOf(tiltDeg, wantedDeg);
  const text = arms.map((arm) => `${texts.ways[arm.way]} ${formatFigure(arm.reachedDeg, 0)}°`).join(", ");
  return (
    <figure className="tilts">
      <svg viewBox="-40 0 280 200" role="img" aria-label={`${texts.tilts}: ${text}`}>
        {arms.map(({ way, reachedDeg, ratio }) => {
          const { x, y, dx, dy } = PLACES[way];
          const to = (share: number): { x2: number; y2: number } => ({
            x2: x + dx * LENGTH * share,
            y2: y + dy * LENGTH * share,
          });
          return (
            <g key={way} data-reached={ratio >= 1}>
              <line className="arm-open" x1={x} y1={y} {...to(1)} />
              <line className="arm-done" x1={x} y1={y} {...to(Math.max(ratio, 0.001))} />
              <text x={x + dx * 94} y={y + dy * 74 + 5} textAnchor="middle">
                {ratio >= 1 ? "✓" : ""}
                {formatFigure(reachedDeg, 0)}°
              </text>
            </g>
          );
        })}
        <rect className="tilt-board" x="88" y="88" width="24" height="24" rx="3" />
      </svg>
      <figcaption>
        {texts.tilts}, {texts.tiltWanted} {formatFigure(wantedDeg, 0)}°
      </figcaption>
    </figure>
  );
}
