import type { ReactNode } from "react";
import type { CollectionMessage } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { interpolate } from "../../texts/interpolate";

type Collected = CollectionMessage;

/** Grid of the image: past positions of the board, and its present corners. */
export function Coverage({ collected }: { collected: Collected }): ReactNode {
  const texts = useTexts().camera;
  const { covered, points_px: points } = collected;
  const width = collected.width_px || 1280;
  const height = collected.height_px || 720;
  const rows = covered.length || 4;
  const columns = covered[0]?.length ?? 6;
  const there = covered.flat().filter(Boolean).length;
  const label = interpolate(texts.coverageAlt, { there, all: rows * columns });
  return (
    <figure className="coverage">
      <svg viewBox={`0 0 ${String(width)} ${String(height)}`} role="img" aria-label={label}>
        {Array.from({ length: rows * columns }, (_, index) => {
          const row = Math.floor(index / columns);
          const column = index % columns;
          return (
            <rect
              key={index}
              className={covered[row]?.[column] === true ? "cell-seen" : "cell-open"}
              x={(column * width) / columns}
              y={(row * height) / rows}
              width={width / columns}
              height={height / rows}
            />
          );
        })}
        {points.map(([x, y], index) => (
          <circle key={index} className="board-point" cx={x} cy={y} r={width / 220} />
        ))}
      </svg>
      <figcaption>{texts.coverageCaption}</figcaption>
    </figure>
  );
}
