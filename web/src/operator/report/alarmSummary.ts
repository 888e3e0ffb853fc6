// The alarm log, line by line, as how often what was alarmed.
export interface AlarmCount {
  condition: string;
  raised: number;
  firstAt: string;
  lastAt: string;
  acknowledgedBy: readonly string[];
  /** The line with its worst value: what was raised again deeper is not understated. */
  line: Line;
}

type Line = Readonly<Record<string, unknown>>;

/** By condition, the most frequent first; lines of another shape are passed over. */
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

/** How far its worst value is past the limit; of a line without numbers 0, so that the last one counts. */
function excessOf({ worst, limit }: Line): number {
  return typeof worst === "number" && typeof limit === "number" ? Math.abs(worst - limit) : 0;
}
