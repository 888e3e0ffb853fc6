// The drill in the vertebra frame, from the same message from which the server computed the figures.
import type { NumbersVerdict } from "../live/assess";
import type { SnapshotMessage } from "../live/messages";
import { dot, minus, vec3, type Vec3 } from "../operator/plan/slices/vectors";
import type { Pose } from "./planes";

export interface Drill {
  pose: Pose;
  radiusMm: number;
  /** Semi-axes of the tip's 95 % ellipsoid and half angle of the axis' 95 % cone; null if unknown. */
  spread: { ellipsoidMm: Vec3[]; coneDeg: number } | null;
  /** Point of the drill nearest to a wall; null outside of the bone. */
  nearest: Vec3 | null;
}

/** Cached per image, since every cut asks several times. */
const drills = new WeakMap<SnapshotMessage, Drill | null>();

/** The drill whose figures are displayed; null if there are none or its position is unknown. */
export function displayedDrill(numbers: NumbersVerdict): Drill | null {
  if (!numbers.live) return null;
  const { snapshot, reading } = numbers;
  const known = drills.get(snapshot);
  if (known !== undefined) return known;
  const drill = drillOf(snapshot, reading.tool);
  drills.set(snapshot, drill);
  return drill;
}

/** The drill of this name; null if it is not placed in the vertebra. */
export function drillOf({ tools, vertebra }: SnapshotMessage, name: string): Drill | null {
  const tool = tools.find((one) => one.name === name);
  if (tool?.pose.kind !== "tool" || vertebra.kind !== "vertebra" || tool.along === null) return null;
  const { camera_from_tool: drill } = tool.pose;
  const { camera_from_vertebra: bone } = vertebra;
  const [tip, origin] = [vec3(drill.translation_mm), vec3(bone.translation_mm)];
  const axis = vec3(drill.rotation.map((row) => row[2]));
  if (tip === null || origin === null || axis === null) return null;
  const { judgement } = tool;
  const nearest = judgement.kind === "judgement" ? judgement.clearance.now : null;
  return {
    pose: { tip: turnedBack(bone.rotation, minus(tip, origin)), axis: turnedBack(bone.rotation, axis) },
    radiusMm: tool.along.drill_radius_mm,
    spread:
      judgement.kind === "judgement"
        ? {
            ellipsoidMm: judgement.spread.tip_ellipsoid_mm.map(vec3).filter((half) => half !== null),
            coneDeg: judgement.spread.cone_95_deg,
          }
        : null,
    nearest: nearest?.kind === "nearest" ? vec3(nearest.point_in_vertebra_mm) : null,
  };
}

/** Applies the transpose of a rotation, which is its inverse. */
function turnedBack(rotation: readonly number[][], direction: Vec3): Vec3 {
  const column = (index: number): Vec3 => vec3(rotation.map((row) => row[index])) ?? [0, 0, 0];
  return [dot(column(0), direction), dot(column(1), direction), dot(column(2), direction)];
}
