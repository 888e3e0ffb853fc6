import type { RuledView } from "./ruler";

/** Needles and camera position: the common part of all needle requests. */
export interface NeedleRequest {
  view: RuledView;
  /** Empty: the three lines of the reference slice. */
  landmarks: string[];
}

const WIRE_RADIUS_MM = 0.8;

export function needleRequestBody(
  request: NeedleRequest,
): NeedleRequest & { radius_mm: number; use_touched: boolean } {
  return { ...request, radius_mm: WIRE_RADIUS_MM, use_touched: false };
}
