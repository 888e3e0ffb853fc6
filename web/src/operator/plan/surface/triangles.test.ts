import { expect, test } from "vitest";
import type { Place } from "../slices/place";
import { outlineOn, trianglesOf } from "./triangles";

/** A pyramid 10 mm high on a square of 8 mm, its tip to the head. */
const POINTS = [-4, -4, 0, 4, -4, 0, 4, 4, 0, -4, 4, 0, 0, 0, 10];
const CORNERS = [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 0, 2, 1, 0, 3, 2];

function ply(points: readonly number[], corners: readonly number[]): ArrayBuffer {
  const head = new TextEncoder().encode(
    "ply\nformat binary_little_endian 1.0\ncomment Coaxial SPACE=LPS UNIT=mm\n" +
      `element vertex ${points.length / 3}\nproperty double x\nproperty double y\nproperty double z\n` +
      `element face ${corners.length / 3}\nproperty list uchar int vertex_indices\nend_header\n`,
  );
  const bytes = new Uint8Array(head.length + points.length * 8 + (corners.length / 3) * 13);
  const view = new DataView(bytes.buffer);
  bytes.set(head);
  points.forEach((one, i) => {
    view.setFloat64(head.length + 8 * i, one, true);
  });
  corners.forEach((one, i) => {
    const at = head.length + points.length * 8 + Math.floor(i / 3) * 13;
    view.setUint8(at, 3);
    view.setInt32(at + 1 + (i % 3) * 4, one, true);
  });
  return bytes.buffer;
}

const axialAt = (z: number): Place =>
  ({
    pixel_mm: [1, 1],
    lps_from_px: [
      [1, 0, 0],
      [0, 1, 0],
      [0, 0, z],
    ],
  }) as unknown as Place;

test("a file of the server is read as it was written", () => {
  const read = trianglesOf(ply(POINTS, CORNERS));
  expect([...(read?.points ?? [])]).toEqual(POINTS);
  expect([...(read?.corners ?? [])]).toEqual(CORNERS);
});

test.each([
  ["cut off", ply(POINTS, CORNERS).slice(0, -3)],
  ["something else", new TextEncoder().encode("solid bone").buffer],
])("a file that is %s gives none", (_, content) => {
  expect(trianglesOf(content)).toBeNull();
});

test("half-way up the pyramid a slice shows a square of half the side", () => {
  const outline = outlineOn(axialAt(5), {
    points: Float64Array.from(POINTS),
    corners: Int32Array.from(CORNERS),
  });
  expect(outline).toHaveLength(4);
  for (const [from, to] of outline) {
    expect(Math.hypot(to[0] - from[0], to[1] - from[1])).toBeCloseTo(4, 9);
    expect(Math.max(Math.abs(from[0]), Math.abs(from[1]))).toBeCloseTo(2, 9);
    expect(from[2]).toBeCloseTo(5, 9);
  }
});

test("beside it a slice shows nothing", () => {
  expect(
    outlineOn(axialAt(11), { points: Float64Array.from(POINTS), corners: Int32Array.from(CORNERS) }),
  ).toEqual([]);
});
