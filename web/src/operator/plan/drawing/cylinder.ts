// A cylinder cut by a slice: exactly the outline that the channel or the screw has there.
import { beyondMm, downOf, normalOf, rightOf, type Place } from "../slices/place";
import { cross, dot, lengthOf, minus, plus, times, unit, type Vec3 } from "../slices/vectors";

const STATIONS = 60;
const CORNERS = 48;
/** The sine below which the slice counts as square to the axis. */
const SQUARE = 1e-3;

/** The corners of the cut, around; none where the slice misses the cylinder. */
export function cylinderOnSlice(place: Place, entry: Vec3, target: Vec3, radiusMm: number): Vec3[] {
  const way = minus(target, entry);
  const axis = unit(way);
  const normal = normalOf(place);
  // From the axis towards the slice, within the section across the cylinder.
  const toSlice = minus(normal, times(axis, dot(normal, axis)));
  const sine = lengthOf(toSlice);
  if (sine < SQUARE) return sectionOf(place, entry, axis, lengthOf(way), radiusMm);
  const inward = times(toSlice, 1 / sine);
  const aside = unit(cross(axis, normal));
  const left: Vec3[] = [];
  const right: Vec3[] = [];
  for (let i = 0; i <= STATIONS; i += 1) {
    const centre = plus(entry, times(way, i / STATIONS));
    const away = beyondMm(place, centre) / sine;
    if (Math.abs(away) > radiusMm) continue;
    const foot = minus(centre, times(inward, away));
    const half = Math.sqrt(radiusMm * radiusMm - away * away);
    left.push(plus(foot, times(aside, half)));
    right.unshift(minus(foot, times(aside, half)));
  }
  return [...left, ...right];
}

/** The circle that a slice square to the axis shows, where it lies between the ends. */
function sectionOf(place: Place, entry: Vec3, axis: Vec3, lengthMm: number, radiusMm: number): Vec3[] {
  const along = -beyondMm(place, entry) * Math.sign(dot(axis, normalOf(place)));
  if (along < 0 || along > lengthMm) return [];
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
