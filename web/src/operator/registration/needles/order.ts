import type { RuledView } from "./ruler";

/** Which needles, seen how: the part that all questions about needles share. */
export interface NeedleRequest {
  view: RuledView;
  /** None: the three lines of the reference slice. */
  landmarks: string[];
}

const WIRE_RADIUS_MM = 0.8;

export function needleRequestBody(
  request: NeedleRequest,
): NeedleRequest & { radius_mm: number; use_touched: boolean } {
  return { ...request, radius_mm: WIRE_RADIUS_MM, use_touched: false };
}
