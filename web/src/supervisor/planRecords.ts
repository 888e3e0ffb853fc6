// Reads the displayed values from a plan document. Missing values are omitted, never guessed.

export interface ChannelShown {
  side: "left" | "right";
  name: string;
  byHand: boolean;
  lengthMm: number | null;
  diameterMm: number | null;
  screw: ScrewShown | null;
}

interface ScrewShown {
  diameterMm: number;
  lengthMm: number;
  minMm: number | null;
  minWall: Wall | null;
  grade: string;
  meanHu: number | null;
}

export interface VertebraShown {
  name: string;
  hasReference: boolean;
  landmarks: number;
  channels: ChannelShown[];
}

const WALLS = ["medial", "lateral", "superior", "inferior"] as const;
type Wall = (typeof WALLS)[number];
type Json = Record<string, unknown>;

export function vertebraeOf(plan: unknown): VertebraShown[] {
  return list(record(plan)["vertebrae"]).map((one) => {
    const vertebra = record(one);
    return {
      name: text(vertebra["name"]),
      hasReference: list(vertebra["references"]).length > 0,
      landmarks: list(vertebra["landmarks"]).length,
      channels: list(vertebra["channels"]).map(channelOf),
    };
  });
}

function channelOf(value: unknown): ChannelShown {
  const planned = record(value);
  const channel = record(planned["channel"]);
  const [screw] = list(planned["screws"]);
  const radius = number(channel["radius_mm"]);
  return {
    side: planned["side"] === "right" ? "right" : "left",
    name: text(channel["name"]),
    byHand: planned["by_hand"] === true,
    lengthMm: distance(channel["entry_in_vertebra_mm"], channel["target_in_vertebra_mm"]),
    diameterMm: radius === null ? null : 2 * radius,
    screw: screw === undefined ? null : screwOf(record(screw)),
  };
}

function screwOf(screw: Json): ScrewShown | null {
  const diameterMm = number(screw["diameter_mm"]);
  const lengthMm = number(screw["length_mm"]);
  if (diameterMm === null || lengthMm === null) return null;
  const clearance = record(screw["clearance"]);
  let nearest: { wall: Wall; mm: number } | null = null;
  for (const wall of WALLS) {
    const mm = number(clearance[`${wall}_mm`]);
    if (mm !== null && (nearest === null || mm < nearest.mm)) nearest = { wall, mm };
  }
  return {
    diameterMm,
    lengthMm,
    minMm: nearest?.mm ?? null,
    minWall: nearest?.wall ?? null,
    grade: text(clearance["grade"]),
    meanHu: number(record(screw["bone"])["mean_hu"]),
  };
}

function distance(from: unknown, to: unknown): number | null {
  const [a, b] = [list(from).map(number), list(to).map(number)];
  if (a.length !== 3 || b.length !== 3) return null;
  const squares = a.map((value, axis) => {
    const other = b[axis] ?? null;
    return value === null || other === null ? NaN : (value - other) ** 2;
  });
  const mm = Math.sqrt(squares.reduce((sum, one) => sum + one, 0));
  return Number.isFinite(mm) ? mm : null;
}

function record(value: unknown): Json {
  return typeof value === "object" && value !== null && !Array.isArray(value) ? (value as Json) : {};
}

function list(value: unknown): unknown[] {
  return Array.isArray(value) ? (value as unknown[]) : [];
}

function number(value: unknown): number | null {
  return typeof value === "number" && Number.isFinite(value) ? value : null;
}

function text(value: unknown): string {
  return typeof value === "string" ? value : "";
}
