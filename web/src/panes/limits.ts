// The surgeon's numbers with their limits. Each limit has one home: what the pedicle leaves is in the plan's
// tolerance, the planned end in the plan's channel, the distance at which a wall is near in the config's alarms.
import type { Reading } from "../live/reading";
import { clearanceMm } from "./verdictText";

export type FigureName = "entry" | "angle" | "depth" | "wall";
export const FIGURES: readonly FigureName[] = ["entry", "angle", "depth", "wall"];

/** within: as planned; over: past a limit; through: past the wall or the planned end. */
export type Standing = "within" | "over" | "through";

export interface Figure {
  value: number | null;
  limit: number | null;
  standing: Standing;
}

export function figureOf(reading: Reading, name: FigureName, warningDistanceMm: number | null): Figure {
  const { deviation, judgement, along } = reading;
  switch (name) {
    case "entry":
      return atMost(deviation.entry_offset_mm, judgement?.certain.room_mm ?? null);
    case "angle":
      return atMost(deviation.angle_deg, judgement?.certain.room_deg ?? null);
    case "depth": {
      const limit = along?.channel_length_mm ?? null;
      return {
        value: deviation.depth_mm,
        limit,
        standing: deviation.remaining_mm < 0 ? "through" : "within",
      };
    }
    case "wall": {
      const value = judgement === null ? null : clearanceMm(judgement.clearance.now);
      return { value, limit: warningDistanceMm, standing: wallStanding(value, warningDistanceMm) };
    }
  }
}

/** No value at all, as of a drill across the channel, is not within anything. */
function atMost(value: number | null, limit: number | null): Figure {
  const over = limit !== null && !(value !== null && value <= limit);
  return { value, limit, standing: over ? "over" : "within" };
}

function wallStanding(value: number | null, limit: number | null): Standing {
  if (value === null) return "within";
  if (value < 0) return "through";
  return limit !== null && value < limit ? "over" : "within";
}
