// Maps the browser's reasons for having no camera to those that the page has texts for.

export type NoCamera = "insecure" | "denied" | "none" | "busy" | "old" | "other";

/** Null if this browser can send a camera. Without https, browsers hide cameras. */
export function unfit(isSecure: boolean, hasCameras: boolean, hasFrames: boolean): NoCamera | null {
  if (!isSecure) return "insecure";
  return hasCameras && hasFrames ? null : "old";
}

export function noCameraOf(error: unknown): NoCamera {
  const name = error instanceof Error || error instanceof DOMException ? error.name : "";
  if (name === "NotAllowedError" || name === "SecurityError") return "denied";
  if (name === "NotFoundError" || name === "OverconstrainedError") return "none";
  return name === "NotReadableError" || name === "AbortError" ? "busy" : "other";
}
