// Type of the plan in `GET /api/plan`, which the server's schema describes only as an object.
import type { PlanMessage } from "../../../api";
import type { Remark } from "../../parts/Remarks";
import type { Vec3 } from "../slices/vectors";

export type PlanAnswer = PlanMessage;
export type Side = "left" | "right";
export const SIDES: readonly Side[] = ["left", "right"];

export const NUMBERS = ["width_mm", "height_mm", "transverse_deg", "sagittal_deg", "length_mm"] as const;
export type NumberName = (typeof NUMBERS)[number];
export type Numbers = Record<NumberName, number>;

export interface Pedicle extends Numbers {
  side: Side;
  isthmus_lps_mm: Vec3;
  axis_lps: Vec3;
  entry_lps_mm: Vec3;
  front_lps_mm: Vec3;
  outline_lps_mm: Vec3[];
  seed_lps_mm: Vec3;
  sd: Numbers & { isthmus_mm: number };
  warnings: Remark[];
}

export interface PedicleRecord {
  measured: Pedicle;
  corrected: Partial<Numbers>;
}

export interface Channel {
  name: string;
  entry_in_vertebra_mm: Vec3;
  target_in_vertebra_mm: Vec3;
  radius_mm: number;
}

export const WALLS = ["medial", "lateral", "superior", "inferior", "anterior"] as const;

export interface Screw {
  diameter_mm: number;
  length_mm: number;
  clearance: Record<`${(typeof WALLS)[number]}_mm`, number> & { breach_mm: number; grade: string };
  tolerance: { max_offset_mm: number; max_angle_deg: number; both_mm: number; both_deg: number };
  bone: { mean_hu: number; min_hu: number; inside_ratio: number };
}

export interface PlannedChannel {
  side: Side;
  channel: Channel;
  by_hand: boolean;
  screws: Screw[];
}

export interface SliceLine {
  name: string;
  ends_lps_mm: [Vec3, Vec3];
}

interface Reference {
  slice_index: number;
  apart_mm: number;
  lines: SliceLine[];
  paths: SliceLine[];
}

export interface Landmark {
  name: string;
  point_lps_mm: Vec3;
}

export interface Vertebra {
  name: string;
  references: Reference[];
  pedicles: PedicleRecord[];
  channels: PlannedChannel[];
  landmarks: Landmark[];
}

export function vertebraeOf(answer: PlanAnswer | null): Vertebra[] {
  const vertebrae = answer?.plan["vertebrae"];
  return Array.isArray(vertebrae) ? (vertebrae as Vertebra[]) : [];
}

/** The pedicle with corrections applied by the server. */
export function usedPedicle(answer: PlanAnswer | null, vertebra: string, side: Side): Pedicle | null {
  return (answer?.used[vertebra]?.[side] as Pedicle | undefined) ?? null;
}

export function recordOf(vertebra: Vertebra, side: Side): PedicleRecord | null {
  return vertebra.pedicles.find((one) => one.measured.side === side) ?? null;
}

export function channelOf(vertebra: Vertebra | null, side: Side): PlannedChannel | null {
  return vertebra?.channels.find((one) => one.side === side) ?? null;
}
