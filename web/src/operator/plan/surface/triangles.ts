// The bone surface on the page: parsed from the server's PLY and cut by a slice, to compare it with the CT.
import type { Place } from "../slices/place";
import { beyondMm } from "../slices/place";
import type { Vec3 } from "../slices/vectors";

export interface Triangles {
  /** Three coordinates per point, LPS in mm. */
  points: Float64Array;
  /** Three indices per triangle. */
  corners: Int32Array;
}

const NUMBER_BYTES = 8;
const FACE_BYTES = 13;

/** Parses a binary PLY of the server; null if it is anything else. */
export function trianglesOf(content: ArrayBuffer): Triangles | null {
  const head = new TextDecoder("ascii").decode(content.slice(0, 1024));
  const end = head.indexOf("end_header\n");
  const count = (of: string): number => Number(new RegExp(`element ${of} (\\d+)`).exec(head)?.[1] ?? NaN);
  const [vertices, faces] = [count("vertex"), count("face")];
  const start = end + "end_header\n".length;
  const facesAt = start + vertices * 3 * NUMBER_BYTES;
  const isKnown = head.startsWith("ply\nformat binary_little_endian") && head.includes("property double x");
  if (end < 0 || !isKnown || content.byteLength !== facesAt + faces * FACE_BYTES) return null;
  const view = new DataView(content);
  const points = Float64Array.from({ length: vertices * 3 }, (_, i) =>
    view.getFloat64(start + i * NUMBER_BYTES, true),
  );
  const corners = Int32Array.from({ length: faces * 3 }, (_, i) =>
    view.getInt32(facesAt + Math.floor(i / 3) * FACE_BYTES + 1 + (i % 3) * 4, true),
  );
  return { points, corners };
}

/** Intersection of a slice with the triangles: pairs of points. */
export function outlineOn(place: Place, { points, corners }: Triangles): [Vec3, Vec3][] {
  const at = (n: number): Vec3 => [points[3 * n] ?? 0, points[3 * n + 1] ?? 0, points[3 * n + 2] ?? 0];
  const beyond = Float64Array.from({ length: points.length / 3 }, (_, n) => beyondMm(place, at(n)));
  const pairs: [Vec3, Vec3][] = [];
  for (let i = 0; i < corners.length; i += 3) {
    const ends: Vec3[] = [];
    for (let k = 0; k < 3; k += 1) {
      const [a, b] = [corners[i + k] ?? 0, corners[i + ((k + 1) % 3)] ?? 0];
      const [from, to] = [beyond[a] ?? 0, beyond[b] ?? 0];
      // A corner on the slice counts as behind it, so that no edge is cut twice.
      if (from < 0 === to < 0) continue;
      const ratio = from / (from - to);
      const [p, q] = [at(a), at(b)];
      ends.push([p[0] + ratio * (q[0] - p[0]), p[1] + ratio * (q[1] - p[1]), p[2] + ratio * (q[2] - p[2])]);
    }
    if (ends[0] !== undefined && ends[1] !== undefined) pairs.push([ends[0], ends[1]]);
  }
  return pairs;
}
