// Tilt of a board to each side.
export type Way = "up" | "down" | "left" | "right";

interface Arm {
  /** The edge that leans away from the camera. */
  way: Way;
  reachedDeg: number;
  /** Share of the required tilt, 0 to 1. */
  ratio: number;
}

/** From minimum and maximum lean (> 0: upper edge away) and turn (> 0: left edge away). */
export function armsOf(tiltDeg: readonly number[], wantedDeg: number): Arm[] {
  const [minLean = 0, maxLean = 0, minTurn = 0, maxTurn = 0] = tiltDeg;
  const reached: [Way, number][] = [
    ["up", maxLean],
    ["down", -minLean],
    ["left", maxTurn],
    ["right", -minTurn],
  ];
  return reached.map(([way, deg]) => {
    const reachedDeg = Math.max(0, deg);
    return { way, reachedDeg, ratio: Math.min(1, reachedDeg / wantedDeg) };
  });
}
