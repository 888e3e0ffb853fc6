// Transform from the patient to page pixels, for drawings over a slice.
import { beyondMm, lpsFromPlane, planeFromLps, type Place, type Vec2 } from "./place";
import type { Vec3 } from "./vectors";
import { planeFromStage, stageFromPlane, type Stage, type Zoom } from "./zoom";

export interface Projection {
  place: Place;
  pxPerMm: number;
  stage: Stage;
  /** Page position of a point's projection, from the stage's top left. */
  at: (point: Vec3) => Vec2;
  /** Point of the slice at this pixel. */
  lpsAt: (px: Vec2) => Vec3;
  beyondMm: (point: Vec3) => number;
}

export function projectionOf(place: Place, zoom: Zoom, stage: Stage): Projection {
  return {
    place,
    pxPerMm: zoom.pxPerMm,
    stage,
    at: (point) => stageFromPlane(zoom, stage, planeFromLps(place, point)),
    lpsAt: (px) => lpsFromPlane(place, planeFromStage(zoom, stage, px)),
    beyondMm: (point) => beyondMm(place, point),
  };
}

/** Points as an SVG path. */
export function pathOf(projection: Projection, points: readonly Vec3[], { closed = false } = {}): string {
  const corners = points.map((point) =>
    projection
      .at(point)
      .map((value) => value.toFixed(1))
      .join(" "),
  );
  return corners.length === 0 ? "" : `M ${corners.join(" L ")}${closed ? " Z" : ""}`;
}
