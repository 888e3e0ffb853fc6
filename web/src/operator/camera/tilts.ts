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
  const [leastLean = 0, mostLean = 0, leastTurn = 0, mostTurn = 0] = tiltDeg;
  const reached: [Way, number][] = [
    ["up", mostLean],
    ["down", -leastLean],
    ["left", mostTurn],
    ["right", -leastTurn],
  ];
  return reached.map(([way, deg]) => {
    const reachedDeg = Math.max(0, deg);
    return { way, reachedDeg, ratio: Math.min(1, reachedDeg / wantedDeg) };
  });
}
