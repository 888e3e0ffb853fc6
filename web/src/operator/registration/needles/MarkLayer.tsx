import type { ReactNode } from "react";
import { useTexts } from "../../../texts/TextsContext";
import { useImageSize } from "../useImageSize";
import type { Marking } from "./marks";
import { useNeedleNames } from "./useNeedleNames";

interface MarkLayerProps {
  marks: readonly Marking[];
  names: readonly string[];
  /** Planned lines after the fit, if any. */
  lines?: readonly number[][][];
}

/** Marked needles: a ring at the bone, a line, a disc at the head, and the name. */
export function MarkLayer({ marks, names, lines = [] }: MarkLayerProps): ReactNode {
  const texts = useTexts().registration.needles;
  const nameOf = useNeedleNames();
  const { widthPx, heightPx } = useImageSize();
  return (
    <svg
      className="lines"
      viewBox={`-0.5 -0.5 ${widthPx} ${heightPx}`}
      role="img"
      aria-label={texts.marksAlt}
      data-testid="marks"
    >
      {lines.map((line, index) => (
        <polyline
          key={names[index]}
          className="line planned"
          points={line.map((one) => one.join(",")).join(" ")}
        />
      ))}
      {marks.map(({ entry_px: [x, y], head_px: head }, index) => (
        <g key={names[index] ?? index} data-needle={index}>
          {head !== undefined && (
            <>
              <line className="line-edge" x1={x} y1={y} x2={head[0]} y2={head[1]} />
              <line className="marked" x1={x} y1={y} x2={head[0]} y2={head[1]} />
              <circle className="head" cx={head[0]} cy={head[1]} r="5" />
            </>
          )}
          <circle cx={x} cy={y} r="9" />
          <text x={(head?.[0] ?? x) + 12} y={head?.[1] ?? y}>
            {nameOf(names[index] ?? "")}
          </text>
        </g>
      ))}
    </svg>
  );
}
