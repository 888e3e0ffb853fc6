import { useEffect, useRef, type ReactNode } from "react";
import { useTexts } from "../../../texts/TextsContext";
import { useImageSize } from "../useImageSize";
import { applyMatrix, type Px } from "./overlay";
import type { OverlayController } from "./overlayController";
import { useNeedleNames } from "./useNeedleNames";

interface LineLayerProps {
  controller: OverlayController;
  names: readonly string[];
}

/** Planned lines of the needles, from the bone outwards. */
export function LineLayer({ controller, names }: LineLayerProps): ReactNode {
  const texts = useTexts().registration.needles;
  const nameOf = useNeedleNames();
  const { widthPx, heightPx } = useImageSize();
  const group = useRef<SVGGElement>(null);
  useEffect(
    () =>
      controller.onPaint(() => {
        const { newest, sinceAnswer } = controller;
        if (group.current === null || newest === null || sinceAnswer === null) return;
        newest.laid.needles.forEach((needle, index) => {
          const points = needle.line_px.map(([x = 0, y = 0]) => applyMatrix(sinceAnswer, [x, y]));
          draw(group.current?.children[index] ?? null, points);
        });
      }),
    // Redrawn when the lines change.
    [controller, names.length],
  );
  return (
    <svg
      className="lines"
      viewBox={`-0.5 -0.5 ${widthPx} ${heightPx}`}
      role="img"
      aria-label={texts.linesAlt}
    >
      <g ref={group} data-testid="lines">
        {names.map((name, index) => (
          <g key={name} data-needle={index} data-name={name}>
            <polyline className="line-edge" />
            <polyline className="line" />
            <circle r="7" />
            <text>{nameOf(name)}</text>
          </g>
        ))}
      </g>
    </svg>
  );
}

function draw(needle: Element | null, points: Px[]): void {
  const [start, end] = [points[0], points.at(-1)];
  if (needle === null || start === undefined || end === undefined) return;
  const text = points.map((point) => point.join(",")).join(" ");
  for (const line of needle.querySelectorAll("polyline")) line.setAttribute("points", text);
  const circle = needle.querySelector("circle");
  circle?.setAttribute("cx", String(start[0]));
  circle?.setAttribute("cy", String(start[1]));
  const label = needle.querySelector("text");
  label?.setAttribute("x", String(end[0] + 8));
  label?.setAttribute("y", String(end[1]));
}
