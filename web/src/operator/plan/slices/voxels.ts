// Transform from the patient to the scanner's voxels.
import type { Ct } from "./address";
import { cross, dot, minus, type Vec3 } from "./vectors";

/** The voxel (i, j, k) at a point, not rounded. */
export function indexFromLps(ct: Pick<Ct, "lps_from_ijk">, point: Vec3): Vec3 {
  const column = (n: number): Vec3 => {
    const [x, y, z] = ct.lps_from_ijk.map((row) => row[n] ?? 0);
    return [x ?? 0, y ?? 0, z ?? 0];
  };
  const [i, j, k, origin] = [column(0), column(1), column(2), column(3)];
  const away = minus(point, origin);
  const volume = dot(i, cross(j, k));
  return [dot(away, cross(j, k)) / volume, dot(away, cross(k, i)) / volume, dot(away, cross(i, j)) / volume];
}

/** Number of the scanner's slice nearest to a point. */
export function sliceIndexAt(ct: Pick<Ct, "lps_from_ijk" | "size_ijk">, point: Vec3): number {
  const last = (ct.size_ijk[2] ?? 1) - 1;
  return Math.min(last, Math.max(0, Math.round(indexFromLps(ct, point)[2])));
}
