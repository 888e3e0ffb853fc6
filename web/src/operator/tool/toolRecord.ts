// Parses a tool document; its content is not trusted.
import type { KnownToolMessage, PoseCollectionMessage, Purpose, ToolCalibrationConfig } from "../../api";

export type { Purpose };
export type KnownTool = KnownToolMessage;
export type ToolGate = ToolCalibrationConfig;
export type PoseCollectionState = PoseCollectionMessage;

interface ToolRecord {
  marker: string;
  sideMm: number | null;
  radiusMm: number | null;
  lengthMm: number | null;
  tipRmsMm: number | null;
  tipPoses: number | null;
  tiltDeg: number | null;
  wobbleDeg: number | null;
  axisSdDeg: number | null;
  spinDeg: number | null;
  /** Whether the axis is known, from a spin or a drawing. */
  hasAxis: boolean;
}

export function toolRecordFrom(content: Record<string, unknown>): ToolRecord {
  const pivot = part(content["pivot"]);
  const spin = part(content["spin"]);
  return {
    marker: typeof content["marker"] === "string" ? content["marker"] : "",
    sideMm: number(content["side_mm"]),
    radiusMm: number(content["radius_mm"]),
    lengthMm: number(content["length_mm"]),
    tipRmsMm: number(pivot["rms_3d_mm"]),
    tipPoses: number(pivot["used"]),
    tiltDeg: number(pivot["tilt_range_deg"]),
    wobbleDeg: number(spin["wobble_deg"]),
    axisSdDeg: number(spin["axis_sd_deg"]),
    spinDeg: number(spin["spin_range_deg"]),
    hasAxis: Array.isArray(spin["axis_in_marker"]) || Array.isArray(content["axis_in_marker"]),
  };
}

/** The recommended next action for this tool. */
export function nextPurpose(tool: KnownTool): Purpose {
  if (tool.calibration?.heading.current !== true) return "pivot";
  return toolRecordFrom(tool.calibration.content).hasAxis ? "tip_check" : "spin";
}

export function number(value: unknown): number | null {
  return typeof value === "number" && Number.isFinite(value) ? value : null;
}

function part(value: unknown): Record<string, unknown> {
  return typeof value === "object" && value !== null ? (value as Record<string, unknown>) : {};
}
