// Points and directions in the patient: LPS, mm.

export type Vec3 = readonly [number, number, number];

export const plus = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const minus = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const times = (a: Vec3, by: number): Vec3 => [a[0] * by, a[1] * by, a[2] * by];
export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const lengthOf = (a: Vec3): number => Math.hypot(...a);
export const unit = (a: Vec3): Vec3 => times(a, 1 / lengthOf(a));

export const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/** Rotation about a unit axis by the right-hand rule (Rodrigues). */
export function turned(a: Vec3, axis: Vec3, angleDeg: number): Vec3 {
  const angle = (angleDeg * Math.PI) / 180;
  const along = times(axis, dot(axis, a) * (1 - Math.cos(angle)));
  return plus(plus(times(a, Math.cos(angle)), times(cross(axis, a), Math.sin(angle))), along);
}

/** Three finite numbers, or null: document content is not trusted. */
export function vec3(value: unknown): Vec3 | null {
  if (!Array.isArray(value) || value.length !== 3) return null;
  const numbers = value.map(Number);
  return numbers.every(Number.isFinite) ? (numbers as unknown as Vec3) : null;
}
