// Counts the lines of the alarm log by alarm.
interface AlarmCount {
  condition: string;
  raised: number;
  firstAt: string;
  lastAt: string;
  acknowledgedBy: readonly string[];
  /** The line with the worst value, so that a deeper repetition is not understated. */
  line: Line;
}

type Line = Readonly<Record<string, unknown>>;

/** By condition, most frequent first; malformed lines are skipped. */
export function alarmsIn(lines: readonly Line[]): AlarmCount[] {
  const counts = new Map<string, AlarmCount>();
  for (const line of lines) {
    const { condition, change, at, by } = line;
    if (typeof condition !== "string" || typeof at !== "string") continue;
    const before = counts.get(condition);
    const isRaised = change === "raised";
    if (before === undefined && !isRaised) continue;
    const people = before?.acknowledgedBy ?? [];
    const isNew = change === "acknowledged" && typeof by === "string" && !people.includes(by);
    counts.set(condition, {
      condition,
      raised: (before?.raised ?? 0) + (isRaised ? 1 : 0),
      firstAt: before?.firstAt ?? at,
      lastAt: isRaised ? at : (before?.lastAt ?? at),
      acknowledgedBy: isNew ? [...people, by] : people,
      line: before === undefined || excessOf(line) >= excessOf(before.line) ? line : before.line,
    });
  }
  return [...counts.values()].sort((a, b) => b.raised - a.raised);
}

/** How far the worst value exceeds the limit; 0 without numbers, so that the last line counts. */
function excessOf({ worst, limit }: Line): number {
  return typeof worst === "number" && typeof limit === "number" ? Math.abs(worst - limit) : 0;
}
