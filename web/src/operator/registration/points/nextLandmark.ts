// Chooses the next landmark.

interface Touchable {
  landmarks: { name: string; touched: boolean }[];
  capture: { landmark: string; state: "looking" | "taken" | "rejected" } | null;
}

/**
 * Returns the selected landmark, else the one whose capture runs or was rejected, else the first one not touched,
 * except the last: the check needs an unused landmark.
 */
export function nextLandmark({ landmarks, capture }: Touchable, picked: string | null): string | null {
  if (picked !== null && landmarks.some((one) => one.name === picked)) return picked;
  if (capture !== null && capture.state !== "taken") return capture.landmark;
  const untouched = landmarks.filter((one) => !one.touched);
  return untouched.length > 1 ? (untouched[0]?.name ?? null) : null;
}
