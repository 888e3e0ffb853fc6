// The slice overlay: moved, rotated and scaled in pixels of the camera's image, as on the server. Between two answers
// it is a similarity; each answer makes it exact.

export type Px = readonly [number, number];
/** 3 x 3, row by row. */
export type Matrix = readonly number[];

export interface Overlay {
  shift_px: [number, number];
  /** Clockwise in the image. */
  rotation_deg: number;
  scale_px_per_mm: number;
  fade_ratio: number;
}

const MIN_SCALE = 0.05;
const MAX_SCALE = 100;

export function translateOverlay(overlay: Overlay, by: Px): Overlay {
  const [x, y] = placeOf(overlay);
  return { ...overlay, shift_px: [x + by[0], y + by[1]] };
}

export function rotateOverlay(overlay: Overlay, byDeg: number, about: Px): Overlay {
  const radians = (byDeg * Math.PI) / 180;
  const [cosine, sine] = [Math.cos(radians), Math.sin(radians)];
  const [x, y] = placeOf(overlay);
  const [armX, armY] = [x - about[0], y - about[1]];
  return {
    ...overlay,
    shift_px: [about[0] + cosine * armX - sine * armY, about[1] + sine * armX + cosine * armY],
    rotation_deg: wrapped(overlay.rotation_deg + byDeg),
  };
}

/** Clamped to the server's limits, with the position adjusted to the clamped scale. */
export function scaleOverlay(overlay: Overlay, byRatio: number, about: Px): Overlay {
  const scale = clamp(overlay.scale_px_per_mm * byRatio, MIN_SCALE, MAX_SCALE);
  const ratio = scale / overlay.scale_px_per_mm;
  const [x, y] = placeOf(overlay);
  return {
    ...overlay,
    shift_px: [about[0] + ratio * (x - about[0]), about[1] + ratio * (y - about[1])],
    scale_px_per_mm: scale,
  };
}

export function fadeOverlay(overlay: Overlay, toRatio: number): Overlay {
  return { ...overlay, fade_ratio: clamp(toRatio, 0, 1) };
}

/** Two fingers: the points under them stay under them. */
export function pinchOverlay(
  overlay: Overlay,
  { from, to, ratio, turnDeg }: { from: Px; to: Px; ratio: number; turnDeg: number },
): Overlay {
  const turnedThere = rotateOverlay(scaleOverlay(overlay, ratio, from), turnDeg, from);
  return translateOverlay(turnedThere, [to[0] - from[0], to[1] - from[1]]);
}

/** Transform from the drawing of one overlay to another. */
export function similarity(from: Overlay, to: Overlay): Matrix {
  const ratio = to.scale_px_per_mm / from.scale_px_per_mm;
  const radians = ((to.rotation_deg - from.rotation_deg) * Math.PI) / 180;
  const [a, b] = [ratio * Math.cos(radians), ratio * Math.sin(radians)];
  const [x, y] = placeOf(from);
  const [toX, toY] = placeOf(to);
  return [a, -b, toX - a * x + b * y, b, a, toY - b * x - a * y, 0, 0, 1];
}

export function multiply(left: Matrix, right: Matrix): Matrix {
  return Array.from({ length: 9 }, (_, at) => {
    const [row, column] = [3 * Math.floor(at / 3), at % 3];
    return [0, 1, 2].reduce((sum, k) => sum + at3(left, row + k) * at3(right, 3 * k + column), 0);
  });
}

export function applyMatrix(matrix: Matrix, [x, y]: Px): Px {
  const [u, v, w] = [0, 3, 6].map(
    (row) => at3(matrix, row) * x + at3(matrix, row + 1) * y + at3(matrix, row + 2),
  ) as [number, number, number];
  return [u / w, v / w];
}

/** For an element with its origin at the top-left corner, half a pixel from the pixel's centre. */
export function cssMatrix(imageFromPicture: Matrix): string {
  const [a, b, c, d, e, f, g, h, i] = multiply(
    multiply([1, 0, 0.5, 0, 1, 0.5, 0, 0, 1], imageFromPicture),
    [1, 0, -0.5, 0, 1, -0.5, 0, 0, 1],
  );
  return `matrix3d(${[a, d, 0, g, b, e, 0, h, 0, 0, 1, 0, c, f, 0, i].join(",")})`;
}

export function isSameOverlay(one: Overlay, other: Overlay): boolean {
  return (
    one.rotation_deg === other.rotation_deg &&
    one.scale_px_per_mm === other.scale_px_per_mm &&
    one.fade_ratio === other.fade_ratio &&
    one.shift_px[0] === other.shift_px[0] &&
    one.shift_px[1] === other.shift_px[1]
  );
}

export function placeOf(overlay: Overlay): Px {
  return overlay.shift_px;
}

function wrapped(degrees: number): number {
  return ((((degrees + 180) % 360) + 360) % 360) - 180;
}

function clamp(value: number, min: number, max: number): number {
  return Math.min(Math.max(value, min), max);
}

function at3(matrix: Matrix, index: number): number {
  return matrix[index] ?? 0;
}
