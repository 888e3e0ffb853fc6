// View of a slice's plane: its centre in mm of the plane, and its scale.
import type { Vec2 } from "./place";

export interface Zoom {
  /** Centre of the stage, in mm of the plane. */
  centre: Vec2;
  /** Page pixels per mm. */
  pxPerMm: number;
}

export interface Stage {
  width: number;
  height: number;
}

interface Box {
  x: number;
  y: number;
  width: number;
  height: number;
}

const CLOSEST_PX_PER_MM = 40;
const FARTHEST_RATIO = 0.6;

/** The whole slice. */
export function whole(frame: Box, stage: Stage): Zoom {
  return {
    centre: [frame.x + frame.width / 2, frame.y + frame.height / 2],
    pxPerMm: Math.min(stage.width / frame.width, stage.height / frame.height),
  };
}

export function planeFromStage(zoom: Zoom, stage: Stage, [x, y]: Vec2): Vec2 {
  return [
    zoom.centre[0] + (x - stage.width / 2) / zoom.pxPerMm,
    zoom.centre[1] + (y - stage.height / 2) / zoom.pxPerMm,
  ];
}

export function stageFromPlane(zoom: Zoom, stage: Stage, [x, y]: Vec2): Vec2 {
  return [
    stage.width / 2 + (x - zoom.centre[0]) * zoom.pxPerMm,
    stage.height / 2 + (y - zoom.centre[1]) * zoom.pxPerMm,
  ];
}

/** Zooms about the point under the fingers. */
export function zoomedAt(zoom: Zoom, stage: Stage, frame: Box, at: Vec2, factor: number): Zoom {
  const fixed = planeFromStage(zoom, stage, at);
  const minPxPerMm = whole(frame, stage).pxPerMm * FARTHEST_RATIO;
  const pxPerMm = Math.min(CLOSEST_PX_PER_MM, Math.max(minPxPerMm, zoom.pxPerMm * factor));
  return clampZoom(
    {
      centre: [
        fixed[0] - (at[0] - stage.width / 2) / pxPerMm,
        fixed[1] - (at[1] - stage.height / 2) / pxPerMm,
      ],
      pxPerMm,
    },
    frame,
  );
}

export function moved(zoom: Zoom, frame: Box, [dx, dy]: Vec2): Zoom {
  return clampZoom(
    { ...zoom, centre: [zoom.centre[0] - dx / zoom.pxPerMm, zoom.centre[1] - dy / zoom.pxPerMm] },
    frame,
  );
}

/** Clamps the centre of the stage to the slice. */
function clampZoom(zoom: Zoom, frame: Box): Zoom {
  const within = (value: number, low: number, size: number): number =>
    Math.min(low + size, Math.max(low, value));
  return {
    ...zoom,
    centre: [within(zoom.centre[0], frame.x, frame.width), within(zoom.centre[1], frame.y, frame.height)],
  };
}

/** Moves the minimum needed to show this point with a margin; unchanged if it is visible. */
export function showing(zoom: Zoom, stage: Stage, [x, y]: Vec2, marginRatio = 0.1): Zoom {
  const half: Vec2 = [
    ((0.5 - marginRatio) * stage.width) / zoom.pxPerMm,
    ((0.5 - marginRatio) * stage.height) / zoom.pxPerMm,
  ];
  const away: Vec2 = [x - zoom.centre[0], y - zoom.centre[1]];
  const isSeen = Math.abs(away[0]) <= half[0] && Math.abs(away[1]) <= half[1];
  return isSeen ? zoom : { ...zoom, centre: [x, y] };
}

/** Ruler length of 1, 2 or 5 times a power of ten, at most this many pixels long. */
export function rulerMm(pxPerMm: number, maxPx: number): number {
  const maxMm = maxPx / pxPerMm;
  const ten = 10 ** Math.floor(Math.log10(maxMm));
  return ([5, 2].find((digit) => digit * ten <= maxMm) ?? 1) * ten;
}
