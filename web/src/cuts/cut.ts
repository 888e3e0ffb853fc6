// A cut through a volume: trilinear Hounsfield units in a plane, as grey pixels. Pure and without imports, so that it
// runs in the worker, in tests and in Node.

export interface Voxels {
  /** i fastest, then j, then k. */
  hu: Int16Array;
  /** Number of voxels along i, j and k. */
  size: readonly [number, number, number];
  /** Rows of the affine from LPS in mm to voxel indices: 3 of 4. */
  indexFromLps: readonly (readonly number[])[];
}

export interface CutPlane {
  /** From (u, v, 1) to LPS in mm; (0, 0) is the centre of the top-left pixel. Rows, 3 of 3. */
  lps_from_px: readonly (readonly number[])[];
  width_px: number;
  height_px: number;
}

export interface GreyWindow {
  window_hu: number;
  level_hu: number;
}

/** A point on the outermost voxels counts as inside despite rounding. */
const BORDER_VOXELS = 1e-4;

/**
 * Writes the cut as RGBA into `pixels` (`width_px * height_px * 4` bytes). Pixels outside of the volume, where HU are
 * unknown, are transparent: black would look like air.
 */
export function drawCut(voxels: Voxels, plane: CutPlane, grey: GreyWindow, pixels: Uint8ClampedArray): void {
  const { hu, size } = voxels;
  const [columns, rows, slices] = size;
  const [stepU, stepV, start] = indexFromPx(voxels, plane);
  const perHu = 255 / grey.window_hu;
  const black = grey.level_hu - grey.window_hu / 2;
  const slice = columns * rows;
  let at = 0;
  for (let v = 0; v < plane.height_px; v += 1) {
    for (let u = 0; u < plane.width_px; u += 1, at += 4) {
      const i = within(start[0] + u * stepU[0] + v * stepV[0], columns);
      const j = within(start[1] + u * stepU[1] + v * stepV[1], rows);
      const k = within(start[2] + u * stepU[2] + v * stepV[2], slices);
      if (i < 0 || j < 0 || k < 0) {
        pixels[at + 3] = 0;
        continue;
      }
      // The last voxel has no next one; it is reached from the previous one with weight 1.
      const i0 = Math.min(Math.floor(i), columns - 2);
      const j0 = Math.min(Math.floor(j), rows - 2);
      const k0 = Math.min(Math.floor(k), slices - 2);
      const [x, y, z] = [i - i0, j - j0, k - k0];
      const low = k0 * slice + j0 * columns + i0;
      const high = low + slice;
      const front = mix(row(hu, low, x), row(hu, low + columns, x), y);
      const back = mix(row(hu, high, x), row(hu, high + columns, x), y);
      const value = (mix(front, back, z) - black) * perHu;
      pixels[at] = value;
      pixels[at + 1] = value;
      pixels[at + 2] = value;
      pixels[at + 3] = 255;
    }
  }
}

function mix(a: number, b: number, share: number): number {
  return a + (b - a) * share;
}

function row(hu: Int16Array, at: number, share: number): number {
  return mix(hu[at] ?? 0, hu[at + 1] ?? 0, share);
}

/** The index clamped to the outermost voxels; negative outside. */
function within(index: number, count: number): number {
  if (index < -BORDER_VOXELS || index > count - 1 + BORDER_VOXELS) return -1;
  return Math.min(Math.max(index, 0), count - 1);
}

type Triple = readonly [number, number, number];

/** Steps of the voxel index per column and row, and the index of the top-left pixel. */
function indexFromPx({ indexFromLps }: Voxels, plane: CutPlane): readonly [Triple, Triple, Triple] {
  const column = (index: number, isPoint: boolean): Triple => {
    const [x, y, z] = plane.lps_from_px.map((one) => one[index] ?? 0);
    const [i, j, k] = indexFromLps.map(
      ([a, b, c, d]) =>
        (a ?? 0) * (x ?? 0) + (b ?? 0) * (y ?? 0) + (c ?? 0) * (z ?? 0) + (isPoint ? (d ?? 0) : 0),
    );
    return [i ?? 0, j ?? 0, k ?? 0];
  };
  return [column(0, false), column(1, false), column(2, true)];
}

/** First three rows of the inverse of an affine with last row 0 0 0 1. */
export function inverseAffine(affine: readonly (readonly number[])[]): number[][] {
  const at = (r: number, c: number): number => affine[r]?.[c] ?? 0;
  const cofactor = (r: number, c: number): number => {
    const [r1, r2] = [(r + 1) % 3, (r + 2) % 3];
    const [c1, c2] = [(c + 1) % 3, (c + 2) % 3];
    return at(r1, c1) * at(r2, c2) - at(r1, c2) * at(r2, c1);
  };
  const determinant = at(0, 0) * cofactor(0, 0) + at(0, 1) * cofactor(0, 1) + at(0, 2) * cofactor(0, 2);
  return [0, 1, 2].map((r) => {
    const line = [0, 1, 2].map((c) => cofactor(c, r) / determinant);
    const [x = 0, y = 0, z = 0] = line;
    return [...line, -(x * at(0, 3) + y * at(1, 3) + z * at(2, 3))];
  });
}
