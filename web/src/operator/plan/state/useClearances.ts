import { getPlanClearances, type ChannelClearanceMessage } from "../../../api";
import { useQuery } from "../../../rest/useQuery";
import type { Side } from "./shape";

// The distances to the bone's surface become known some seconds after the channel was chosen for drilling.
const EVERY_MS = 5000;

export interface Clearances {
  marginMm: number;
  of: (vertebra: string, side: Side) => ChannelClearanceMessage["clearance"] | null;
}

/** Clearance of each screw of this version of the plan; null while unknown, also after a change of the plan. */
export function useClearances(planId: string | null): Clearances | null {
  const { data } = useQuery(
    (signal) => (planId === null ? Promise.resolve(null) : getPlanClearances({ signal })),
    { key: planId ?? "", everyMs: EVERY_MS },
  );
  if (data === null || data.plan_id !== planId) return null;
  return {
    marginMm: data.margin_mm,
    of: (vertebra, side) =>
      data.channels.find((one) => one.vertebra === vertebra && one.side === side)?.clearance ?? null,
  };
}
