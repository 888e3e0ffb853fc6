// Overlay of a cut, to scale: outlines in mm of its plane, x right and y down from the middle of the top-left pixel.
// Pure.
import type { ChannelMessage } from "../live/messages";
import { cylinderOnSlice } from "../operator/plan/drawing/cylinder";
import {
  downOf,
  frameOf,
  normalOf,
  planeFromLps,
  rightOf,
  type PixelGrid,
  type Vec2,
} from "../operator/plan/slices/place";
import { dot, minus, plus, times, unit, vec3, type Vec3 } from "../operator/plan/slices/vectors";
import type { Drill } from "./drill";
import { directionLetter, isAnatomical, type CutName, type Pose } from "./planes";

/** SVG paths by content; empty if there is nothing to show. */
export const PARTS = [
  "channel",
  "screw",
  "placed",
  "axis",
  "entry",
  "target",
  "rings",
  "tolerance",
  "cone",
  "ahead",
  "shaft",
  "ring",
  "ellipse",
  "wall",
  "off",
] as const;
type Part = (typeof PARTS)[number];

export interface Overlay {
  paths: Record<Part, string>;
  /** Labels of the ticks and rings, in mm. */
  labels: { text: string; at: Vec2 }[];
  /** The patient's direction at each edge. */
  edges: Record<"left" | "right" | "top" | "bottom", string>;
}

const RINGS_MM = [1, 2, 5];
const TICKS_MM = [10, 20, 30, 40, 50];
const TICK_HALF_MM = 1.6;
const SHAFT_MM = 200;
const CROSS_MM = 0.9;
/** Half of a label on the smallest cuts. */
const LABEL_MARGIN_MM = 2;
const WALL_MM = 1.1;
const ARROW_MM = 2.2;
const CORNERS = 64;
/** Square roots of the 95 % quantiles of chi-square with 2 and 3 degrees of freedom. */
const SD_95_OF_2 = 2.4477;
const SD_95_OF_3 = 2.7955;
/** Above this angle to the planned axis (84 degrees) an intersection is meaningless. */
const MIN_ALONG = 0.1;
/** A path foreshortened below this has no ticks: 10 mm take less than 4 mm of the cut. */
const MIN_TICKED = 0.4;

interface Planned {
  entry: Vec3;
  target: Vec3;
  axis: Vec3;
}

/** The plan as a pose (entry and axis), from which a cut shows the plan without a drill. */
export function planPose(channel: ChannelMessage): Pose | null {
  const planned = plannedOf(channel);
  return planned === null ? null : { tip: planned.entry, axis: planned.axis };
}

export function overlayOf(
  name: CutName,
  grid: PixelGrid,
  {
    channel,
    drill,
    aheadMm,
    maxOffsetMm,
  }: {
    channel: ChannelMessage | null;
    /** Null if only the plan is shown. */
    drill: Drill | null;
    aheadMm: number;
    /** Limit of the entry figure; null if there is none. */
    maxOffsetMm: number | null;
  },
): Overlay {
  const overlay: Overlay = {
    paths: Object.fromEntries(PARTS.map((part) => [part, ""])) as Record<Part, string>,
    labels: [],
    edges: edgesOf(grid),
  };
  const planned = channel === null ? null : plannedOf(channel);
  if (channel !== null && planned !== null) drawPlan(overlay, grid, channel, planned);
  if (name === "probe") {
    if (planned !== null) drawTarget(overlay, grid, planned, drill, maxOffsetMm);
    if (drill !== null) drawAcross(overlay, grid, drill, aheadMm);
  } else if (drill !== null) {
    if (isAnatomical(name)) drawThrough(overlay, grid, drill);
    else drawAlong(overlay, grid, drill);
  }
  // A part of a number is another number.
  overlay.labels = overlay.labels.filter(({ at }) => isWithin(grid, at, LABEL_MARGIN_MM));
  return overlay;
}

function plannedOf({ entry_in_vertebra_mm, target_in_vertebra_mm }: ChannelMessage): Planned | null {
  const [entry, target] = [vec3(entry_in_vertebra_mm), vec3(target_in_vertebra_mm)];
  if (entry === null || target === null) return null;
  return { entry, target, axis: unit(minus(target, entry)) };
}

function isWithin(grid: PixelGrid, [x, y]: Vec2, marginMm: number): boolean {
  const frame = frameOf(grid);
  const [right, bottom] = [frame.x + frame.width, frame.y + frame.height];
  return Math.min(x - frame.x, right - x, y - frame.y, bottom - y) >= marginMm;
}

function edgesOf(grid: PixelGrid): Overlay["edges"] {
  const [right, down] = [rightOf(grid), downOf(grid)];
  return {
    left: directionLetter(times(right, -1)),
    right: directionLetter(right),
    top: directionLetter(times(down, -1)),
    bottom: directionLetter(down),
  };
}

/** Channel, planned and placed screws intersected with the plane, and the planned axis projected onto it. */
function drawPlan({ paths }: Overlay, grid: PixelGrid, channel: ChannelMessage, planned: Planned): void {
  const { entry, target, axis } = planned;
  const onPlane = (points: readonly Vec3[]): string => closed(points.map((one) => planeFromLps(grid, one)));
  paths.channel = onPlane(cylinderOnSlice(grid, entry, target, channel.radius_mm));
  if (channel.screw !== null) {
    const end = plus(entry, times(axis, channel.screw.length_mm));
    paths.screw = onPlane(cylinderOnSlice(grid, entry, end, channel.screw.diameter_mm / 2));
  }
  paths.placed = channel.placed_screws
    .map(({ head_in_vertebra_mm, tip_in_vertebra_mm, diameter_mm }) => {
      const [head, tip] = [vec3(head_in_vertebra_mm), vec3(tip_in_vertebra_mm)];
      return head === null || tip === null ? "" : onPlane(cylinderOnSlice(grid, head, tip, diameter_mm / 2));
    })
    .join("");
  const [from, to] = [planeFromLps(grid, entry), planeFromLps(grid, target)];
  paths.axis = line([from, to]);
  paths.entry = circle(from, CROSS_MM);
  paths.target = cross(to, CROSS_MM);
}

/** In a cut through the tip that need not contain the drill: the drill's intersection, and its projected path. */
function drawThrough(overlay: Overlay, grid: PixelGrid, drill: Drill): void {
  const { tip, axis } = drill.pose;
  drawAlong(overlay, grid, drill);
  const outline = cylinderOnSlice(grid, plus(tip, times(axis, -SHAFT_MM)), tip, drill.radiusMm);
  overlay.paths.shaft = closed(outline.map((one) => planeFromLps(grid, one)));
  overlay.paths.ring = cross(planeFromLps(grid, tip), CROSS_MM);
}

/** In a cut that contains the drill: shaft, path with a tick every 10 mm, and the uncertainty of both. */
function drawAlong(overlay: Overlay, grid: PixelGrid, drill: Drill): void {
  const { paths, labels } = overlay;
  const tip = planeFromLps(grid, drill.pose.tip);
  const covariance = drill.spread === null ? null : covarianceOn(grid, drill.spread.ellipsoidMm);
  if (covariance !== null) paths.ellipse = closed(ellipse(tip, halfAxes95(covariance)));
  const step = flat(grid, drill.pose.axis);
  const length = Math.hypot(...step);
  if (length < MIN_ALONG) return;
  const along: Vec2 = [step[0] / length, step[1] / length];
  const aside: Vec2 = [-along[1], along[0]];
  const at = (aheadMm: number, asideMm: number): Vec2 => [
    tip[0] + step[0] * aheadMm + aside[0] * asideMm,
    tip[1] + step[1] * aheadMm + aside[1] * asideMm,
  ];
  const r = drill.radiusMm;
  paths.shaft = closed([at(-SHAFT_MM, r), at(0, r), at(0, -r), at(-SHAFT_MM, -r)]);
  const last = TICKS_MM.at(-1) ?? 0;
  // Nearly end-on, ticks and labels would overlap.
  const ticks = length < MIN_TICKED ? [] : TICKS_MM;
  paths.ahead = [
    line([tip, at(last, 0)]),
    ...ticks.map((ahead) => line([at(ahead, -TICK_HALF_MM), at(ahead, TICK_HALF_MM)])),
  ].join("");
  for (const ahead of ticks) labels.push({ text: `${ahead}`, at: at(ahead, TICK_HALF_MM + 2.2) });
  if (drill.spread === null || covariance === null) return;
  const beside = SD_95_OF_2 * Math.sqrt(Math.max(quadratic(covariance, aside), 0));
  const widening = Math.tan((drill.spread.coneDeg * Math.PI) / 180);
  paths.cone = [1, -1]
    .map((side) => line([at(0, side * beside), at(last, side * (beside + widening * last))]))
    .join("");
}

/** In a cut across the drill: its ring, and the uncertainty of its axis at this depth. */
function drawAcross({ paths }: Overlay, grid: PixelGrid, drill: Drill, aheadMm: number): void {
  const centre = planeFromLps(grid, drill.pose.tip);
  paths.ring = circle(centre, drill.radiusMm) + cross(centre, CROSS_MM);
  if (drill.spread !== null) {
    const widening = aheadMm * Math.tan((drill.spread.coneDeg * Math.PI) / 180);
    const halves = halfAxes95(covarianceOn(grid, drill.spread.ellipsoidMm)).map((half) => {
      const length = Math.hypot(...half);
      const factor = length < 1e-9 ? 0 : (length + widening) / length;
      return [half[0] * factor, half[1] * factor] as const;
    });
    paths.ellipse = closed(ellipse(centre, halves));
  }
  if (drill.nearest === null || aheadMm !== 0) return;
  const nearest = planeFromLps(grid, drill.nearest);
  const [x, y] = [nearest[0] - centre[0], nearest[1] - centre[1]];
  const away = Math.hypot(x, y);
  if (away < 1e-6) return;
  const [dx, dy] = [(-y / away) * WALL_MM, (x / away) * WALL_MM];
  paths.wall = line([
    [nearest[0] - dx, nearest[1] - dy],
    [nearest[0] + dx, nearest[1] + dy],
  ]);
}

/** Bull's-eye: the planned axis' intersection with this plane, with rings of 1, 2 and 5 mm. */
function drawTarget(
  { paths, labels }: Overlay,
  grid: PixelGrid,
  planned: Planned,
  drill: Drill | null,
  maxOffsetMm: number | null,
): void {
  // Projection along the plane's normal would be wrong here; the intersection is exact.
  paths.axis = paths.entry = paths.target = "";
  const normal = normalOf(grid);
  const along = dot(planned.axis, normal);
  if (Math.abs(along) < MIN_ALONG) return;
  const origin: Vec3 = vec3(grid.lps_from_px.map((row) => row[2])) ?? planned.entry;
  const ahead = dot(minus(origin, planned.entry), normal) / along;
  const at = planeFromLps(grid, plus(planned.entry, times(planned.axis, ahead)));
  paths.target = cross(at, CROSS_MM);
  paths.rings = RINGS_MM.map((radius) => circle(at, radius)).join("");
  for (const radius of RINGS_MM.slice(1)) {
    labels.push({ text: `${radius}`, at: [at[0] + radius * Math.SQRT1_2, at[1] - radius * Math.SQRT1_2] });
  }
  if (maxOffsetMm !== null) paths.tolerance = circle(at, maxOffsetMm);
  if (drill !== null) paths.off = towards(grid, planeFromLps(grid, drill.pose.tip), at);
}

/** From the drill to the planned axis; an arrow at the border if the axis is outside. */
function towards(grid: PixelGrid, from: Vec2, to: Vec2): string {
  const { x, y, width, height } = frameOf(grid);
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  const reach = Math.min(
    dx === 0 ? Infinity : ((dx > 0 ? x + width : x) - from[0]) / dx,
    dy === 0 ? Infinity : ((dy > 0 ? y + height : y) - from[1]) / dy,
  );
  if (!(reach < 1)) return line([from, to]);
  const end: Vec2 = [from[0] + dx * reach, from[1] + dy * reach];
  const length = Math.hypot(dx, dy);
  const [ux, uy] = [(dx / length) * ARROW_MM, (dy / length) * ARROW_MM];
  return (
    line([from, end]) +
    line([[end[0] - ux - uy, end[1] - uy + ux], end, [end[0] - ux + uy, end[1] - uy - ux]])
  );
}

/** A direction of the patient within the plane. */
function flat(grid: PixelGrid, direction: Vec3): Vec2 {
  return [dot(direction, rightOf(grid)), dot(direction, downOf(grid))];
}

/** xx, xy, yy of the tip's covariance in the plane, from the semi-axes of its 95 % ellipsoid. */
type Covariance = readonly [number, number, number];

function covarianceOn(grid: PixelGrid, ellipsoidMm: readonly Vec3[]): Covariance {
  let [xx, xy, yy] = [0, 0, 0];
  for (const half of ellipsoidMm) {
    const [x, y] = flat(grid, times(half, 1 / SD_95_OF_3));
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  return [xx, xy, yy];
}

function quadratic([xx, xy, yy]: Covariance, [x, y]: Vec2): number {
  return xx * x * x + 2 * xy * x * y + yy * y * y;
}

/** Semi-axes of the 95 % ellipse of this covariance. */
export function halfAxes95([xx, xy, yy]: Covariance): Vec2[] {
  const angle = Math.atan2(2 * xy, xx - yy) / 2;
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return (
    [
      [c, s],
      [-s, c],
    ] as const
  ).map((axis) => {
    const length = SD_95_OF_2 * Math.sqrt(Math.max(quadratic([xx, xy, yy], axis), 0));
    return [axis[0] * length, axis[1] * length];
  });
}

function ellipse(at: Vec2, [first, second]: readonly Vec2[]): Vec2[] {
  if (first === undefined || second === undefined) return [];
  return Array.from({ length: CORNERS }, (_, index) => {
    const turn = (2 * Math.PI * index) / CORNERS;
    const [c, s] = [Math.cos(turn), Math.sin(turn)];
    return [at[0] + c * first[0] + s * second[0], at[1] + c * first[1] + s * second[1]];
  });
}

function line(points: readonly Vec2[]): string {
  return points.length === 0 ? "" : `M${points.map(([x, y]) => `${fixed(x)} ${fixed(y)}`).join("L")}`;
}

function closed(points: readonly Vec2[]): string {
  return points.length === 0 ? "" : `${line(points)}Z`;
}

function circle([x, y]: Vec2, radius: number): string {
  const r = fixed(radius);
  return `M${fixed(x - radius)} ${fixed(y)}a${r} ${r} 0 1 0 ${fixed(2 * radius)} 0a${r} ${r} 0 1 0 ${fixed(-2 * radius)} 0Z`;
}

function cross([x, y]: Vec2, half: number): string {
  return (
    line([
      [x - half, y],
      [x + half, y],
    ]) +
    line([
      [x, y - half],
      [x, y + half],
    ])
  );
}

function fixed(value: number): string {
  return value.toFixed(2);
}
