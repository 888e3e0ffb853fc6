// Exact outline of a cylinder (channel or screw) on a slice.
import { beyondMm, downOf, normalOf, rightOf, type PixelGrid } from "../slices/place";
import { cross, dot, lengthOf, minus, plus, times, unit, type Vec3 } from "../slices/vectors";

const STATIONS = 60;
const CORNERS = 48;
/** Sine below which the slice counts as perpendicular to the axis. */
const SQUARE = 1e-3;
/** A slice this little beyond an end still shows it: the places of slices are rounded to 0.001 mm. */
const AT_END_MM = 0.01;

/** Corners of the outline in order; empty if the slice misses the cylinder. */
export function cylinderOnSlice(place: PixelGrid, entry: Vec3, target: Vec3, radiusMm: number): Vec3[] {
  const way = minus(target, entry);
  const axis = unit(way);
  const normal = normalOf(place);
  // From the axis towards the slice, within the cross-section.
  const toSlice = minus(normal, times(axis, dot(normal, axis)));
  const sine = lengthOf(toSlice);
  if (sine < SQUARE) return sectionOf(place, entry, axis, lengthOf(way), radiusMm);
  const inward = times(toSlice, 1 / sine);
  const aside = unit(cross(axis, normal));
  // The distance of the slice from the axis is linear along it; the outline exists where it is below the radius.
  const [atEntry, atTarget] = [beyondMm(place, entry) / sine, beyondMm(place, target) / sine];
  const [from, to] = ratiosWithin(atEntry, atTarget, radiusMm);
  if (from > to) return [];
  const left: Vec3[] = [];
  const right: Vec3[] = [];
  for (let i = 0; i <= STATIONS; i += 1) {
    // Denser towards the ends, where the outline is round.
    const ratio = from + ((to - from) * (1 - Math.cos((Math.PI * i) / STATIONS))) / 2;
    const away = atEntry + (atTarget - atEntry) * ratio;
    const foot = minus(plus(entry, times(way, ratio)), times(inward, away));
    const half = Math.sqrt(Math.max(radiusMm * radiusMm - away * away, 0));
    left.push(plus(foot, times(aside, half)));
    right.unshift(minus(foot, times(aside, half)));
  }
  return [...left, ...right];
}

/** Interval of 0..1 in which a value that is linear from `first` to `last` is within the limit. */
function ratiosWithin(first: number, last: number, limit: number): readonly [number, number] {
  const step = last - first;
  if (Math.abs(step) < 1e-9) return Math.abs(first) <= limit ? [0, 1] : [1, 0];
  const ends = [(-limit - first) / step, (limit - first) / step];
  return [Math.max(0, Math.min(...ends)), Math.min(1, Math.max(...ends))];
}

/** The circle on a slice perpendicular to the axis, if it is between the ends. */
function sectionOf(place: PixelGrid, entry: Vec3, axis: Vec3, lengthMm: number, radiusMm: number): Vec3[] {
  const along = -beyondMm(place, entry) * Math.sign(dot(axis, normalOf(place)));
  if (along < -AT_END_MM || along > lengthMm + AT_END_MM) return [];
  const centre = plus(entry, times(axis, along));
  return Array.from({ length: CORNERS }, (_, i) => {
    const angle = (2 * Math.PI * i) / CORNERS;
    return plus(
      centre,
      plus(
        times(rightOf(place), radiusMm * Math.cos(angle)),
        times(downOf(place), radiusMm * Math.sin(angle)),
      ),
    );
  });
}
