// Planned channels of a plan document; its content is not trusted.
interface ReportedChannel {
  vertebra: string;
  side: string;
  diameterMm: number | null;
  lengthMm: number | null;
  byHand: boolean;
  screw: { diameterMm: number | null; lengthMm: number | null } | null;
}

export function channelsIn(content: Record<string, unknown>): ReportedChannel[] {
  return parts(content["vertebrae"]).flatMap((vertebra) =>
    parts(vertebra["channels"]).map((planned) => {
      const channel = part(planned["channel"]);
      const radiusMm = number(channel["radius_mm"]);
      const screw = parts(planned["screws"])[0];
      return {
        vertebra: text(vertebra["name"]),
        side: text(planned["side"]),
        diameterMm: radiusMm === null ? null : 2 * radiusMm,
        lengthMm: between(channel["entry_in_vertebra_mm"], channel["target_in_vertebra_mm"]),
        byHand: planned["by_hand"] === true,
        screw:
          screw === undefined
            ? null
            : { diameterMm: number(screw["diameter_mm"]), lengthMm: number(screw["length_mm"]) },
      };
    }),
  );
}

/** Length of the channel, from entry point to end. */
function between(entry: unknown, target: unknown): number | null {
  if (!Array.isArray(entry) || !Array.isArray(target)) return null;
  const length = Math.hypot(...entry.map((value, axis) => Number(target[axis]) - Number(value)));
  return Number.isFinite(length) ? length : null;
}

function part(value: unknown): Record<string, unknown> {
  return typeof value === "object" && value !== null ? (value as Record<string, unknown>) : {};
}

const parts = (value: unknown): Record<string, unknown>[] =>
  Array.isArray(value) ? (value as unknown[]).map(part) : [];
const text = (value: unknown): string => (typeof value === "string" ? value : "");
const number = (value: unknown): number | null =>
  typeof value === "number" && Number.isFinite(value) ? value : null;
