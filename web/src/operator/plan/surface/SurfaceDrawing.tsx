import { useMemo, type ReactNode } from "react";
import type { Projection } from "../slices/projection";
import { outlineOn, type Triangles } from "./triangles";

/** Outline of the surface on a slice, which should follow the edge of the bone. */
export function SurfaceDrawing({
  projection,
  triangles,
}: {
  projection: Projection;
  triangles: Triangles;
}): ReactNode {
  const { place } = projection;
  const outline = useMemo(() => outlineOn(place, triangles), [place, triangles]);
  const path = outline
    .map(
      (pair) =>
        `M ${pair
          .map((end) =>
            projection
              .at(end)
              .map((one) => one.toFixed(1))
              .join(" "),
          )
          .join(" L ")}`,
    )
    .join(" ");
  return <path className="draw-surface" data-testid="draw-surface" d={path} />;
}
