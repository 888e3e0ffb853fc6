// How far a board was tilted, side by side of it.
export type Way = "up" | "down" | "left" | "right";

export interface Arm {
  /** The edge of the board that leans away from the camera. */
  way: Way;
  reachedDeg: number;
  /** 0 to 1, of what is wanted. */
  ratio: number;
}

/** From least and most lean (upper edge away is above 0), least and most turn (left edge away is above 0). */
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
