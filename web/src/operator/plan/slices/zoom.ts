// What part of a slice's plane is seen: its middle in mm of the plane, and how large it is shown.
import type { Vec2 } from "./place";

export interface Zoom {
  /** The middle of the stage, in mm of the plane. */
  centre: Vec2;
  /** Pixels of the page to a millimetre. */
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

/** Closer or farther, with the point under the fingers staying where it is. */
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

/** The middle of the stage stays on the slice: nobody loses it. */
function clampZoom(zoom: Zoom, frame: Box): Zoom {
  const within = (value: number, low: number, size: number): number =>
    Math.min(low + size, Math.max(low, value));
  return {
    ...zoom,
    centre: [within(zoom.centre[0], frame.x, frame.width), within(zoom.centre[1], frame.y, frame.height)],
  };
}

/** Moved just so far that this point is seen, with a margin; the same where it is seen already. */
export function showing(zoom: Zoom, stage: Stage, [x, y]: Vec2, marginRatio = 0.1): Zoom {
  const half: Vec2 = [
    ((0.5 - marginRatio) * stage.width) / zoom.pxPerMm,
    ((0.5 - marginRatio) * stage.height) / zoom.pxPerMm,
  ];
  const away: Vec2 = [x - zoom.centre[0], y - zoom.centre[1]];
  const isSeen = Math.abs(away[0]) <= half[0] && Math.abs(away[1]) <= half[1];
  return isSeen ? zoom : { ...zoom, centre: [x, y] };
}

/** The length of a ruler that is easily read: 1, 2 or 5 times a power of ten, at most so many pixels long. */
export function rulerMm(pxPerMm: number, maxPx: number): number {
  const maxMm = maxPx / pxPerMm;
  const ten = 10 ** Math.floor(Math.log10(maxMm));
  return ([5, 2].find((digit) => digit * ten <= maxMm) ?? 1) * ten;
}
