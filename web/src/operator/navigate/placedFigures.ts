// Figures of a placed screw as one line. Pure.
import { formatNumber } from "../../live/rounding";
import type { PlacementMessage } from "../../api";
import type { Texts } from "../../texts/en";
import { interpolate } from "../../texts/interpolate";

type Placement = PlacementMessage;

/** Entry, angle, error and wall as they were displayed; missing ones are omitted. */
export function placedFigures(placement: Placement, texts: Texts): string {
  const { screws } = texts.navigate;
  const { figures, wall, clearance_mm, grade } = placement;
  const known = (name: keyof Placement["figures"]): number | null => figures[name]?.value ?? null;
  const [entry, angle, error, depth] = [known("entry"), known("angle"), known("error"), known("depth")];
  const planned = figures.depth?.limit ?? null;
  return [
    depth === null || planned === null
      ? ""
      : interpolate(screws.depth, { mm: formatNumber(depth, 1), planned: formatNumber(planned, 1) }),
    entry === null ? "" : interpolate(screws.entry, { mm: formatNumber(entry, 1) }),
    angle === null ? "" : interpolate(screws.angle, { deg: formatNumber(angle, 1) }),
    error === null ? "" : interpolate(screws.error, { mm: formatNumber(error, 2) }),
    wall === null || clearance_mm === null
      ? ""
      : interpolate(screws.wall, { wall: texts.wall.side[wall], mm: formatNumber(clearance_mm, 1) }),
    grade === null ? "" : interpolate(screws.grade, { grade }),
  ]
    .filter((part) => part !== "")
    .join(" · ");
}
