// Which landmark is asked for next.

interface Touchable {
  landmarks: { name: string; touched: boolean }[];
  capture: { landmark: string; state: "looking" | "taken" | "rejected" } | null;
}

/**
 * The one that somebody has picked, else the one whose capture runs or was rejected, else the first that was
 * not touched, but for the last of all: the check needs one that was not used.
 */
export function nextLandmark({ landmarks, capture }: Touchable, picked: string | null): string | null {
  if (picked !== null && landmarks.some((one) => one.name === picked)) return picked;
  if (capture !== null && capture.state !== "taken") return capture.landmark;
  const untouched = landmarks.filter((one) => !one.touched);
  return untouched.length > 1 ? (untouched[0]?.name ?? null) : null;
}
