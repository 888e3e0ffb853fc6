// Shade of a vertebra's label, so that neighbours differ.

const SHADES = 4;
const FIRST: Readonly<Record<string, number>> = { C: 0, T: 7, L: 19, S: 24 };

export function shadeOf(level: string): number {
  return ((FIRST[level.slice(0, 1)] ?? 0) + Number(level.slice(1)) - 1) % SHADES;
}
