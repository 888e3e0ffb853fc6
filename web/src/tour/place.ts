// Where the card of the tour covers no alarm.
import type { Span } from "../operator/parts/inSight";

export type Place = "bottom" | "top" | "folded";

interface Room {
  heightPx: number;
  /** Vertical extent of the alarms. */
  alarms: Span;
  cardPx: number;
  /** Distance of the card from the edge of the window. */
  marginPx: number;
}

/** At the bottom, or at the top if the alarms are down there; folded to its buttons if neither is free. */
export function placeBeside({ heightPx, alarms, cardPx, marginPx }: Room): Place {
  if (alarms.bottom <= heightPx - cardPx - marginPx || alarms.top >= heightPx) return "bottom";
  if (alarms.top >= cardPx + marginPx || alarms.bottom <= 0) return "top";
  return "folded";
}
