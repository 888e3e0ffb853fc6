// Transform between image pixels and page pixels. The picture is shown completely, centred in its stage.
import type { Point } from "../room/messages";

export interface Size {
  width: number;
  height: number;
}

export interface Placement {
  /** Page pixels per image pixel. */
  scale: number;
  left: number;
  top: number;
  image: Size;
}

/** Null if the stage or the image has no size. */
export function placed(image: Size, stage: Size): Placement | null {
  if (!(image.width > 0 && image.height > 0 && stage.width > 0 && stage.height > 0)) return null;
  const scale = Math.min(stage.width / image.width, stage.height / image.height);
  return {
    scale,
    left: (stage.width - scale * image.width) / 2,
    top: (stage.height - scale * image.height) / 2,
    image,
  };
}

/** The centre of pixel (0, 0) is half a pixel inside the picture. */
export function onStage([x, y]: Point, { scale, left, top }: Placement): Point {
  return [left + (x + 0.5) * scale, top + (y + 0.5) * scale];
}

/** Rounded to a tenth of a pixel and clamped to the picture. */
export function onImage([x, y]: Point, { scale, left, top, image }: Placement): Point {
  return [
    within((x - left) / scale - 0.5, image.width - 1),
    within((y - top) / scale - 0.5, image.height - 1),
  ];
}

export function isOnImage([x, y]: Point, { scale, left, top, image }: Placement): boolean {
  return x >= left && y >= top && x <= left + scale * image.width && y <= top + scale * image.height;
}

function within(value: number, max: number): number {
  return Math.round(Math.min(Math.max(value, 0), max) * 10) / 10;
}
