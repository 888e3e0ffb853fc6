// Camera constraints and settings. Focus and zoom: W3C MediaStream Image Capture.
import type { CameraFacts, Focus, Welcome } from "./messages";

interface Range {
  min?: number;
  max?: number;
}

export interface Capabilities {
  focusMode?: readonly string[];
  focusDistance?: Range;
}

interface Settings {
  width?: number;
  height?: number;
  frameRate?: number;
  focusMode?: string;
  /** In metres. */
  focusDistance?: number;
  zoom?: number;
}

interface FocusConstraint extends MediaTrackConstraintSet {
  focusMode: string;
  focusDistance?: number;
}

interface Constraints extends MediaTrackConstraints {
  resizeMode: { ideal: string };
  advanced?: FocusConstraint[];
}

/** The rear camera, at a native size of its sensor: not scaled or cropped by the browser. */
export function requestedConstraints(welcome: Welcome): Constraints {
  return {
    facingMode: { ideal: "environment" },
    width: { ideal: welcome.width_px },
    height: { ideal: welcome.height_px },
    frameRate: { ideal: welcome.rate_hz },
    resizeMode: { ideal: "none" },
  };
}

/**
 * Constraints with the focus locked at its calibrated distance, else at its present one; null if this browser
 * cannot, or the settings do not ask for it. Constraints replace each other, so all are given again.
 */
export function withLockedFocus(
  welcome: Welcome,
  capabilities: Capabilities,
  settings: Settings,
): Constraints | null {
  if (!welcome.lock_focus || !(capabilities.focusMode ?? []).includes("manual")) return null;
  const { min, max } = capabilities.focusDistance ?? {};
  const focusM = welcome.focus_mm === null ? settings.focusDistance : welcome.focus_mm / 1000;
  const lock =
    focusM === undefined || min === undefined || max === undefined
      ? { focusMode: "manual" }
      : { focusMode: "manual", focusDistance: Math.min(Math.max(focusM, min), max) };
  return { ...requestedConstraints(welcome), advanced: [lock] };
}

/** What the server receives: the size of the frames, the rest from the track's settings. */
export function factsOf(
  label: string,
  size: { width: number; height: number },
  settings: Settings,
): CameraFacts {
  const { frameRate, focusDistance, zoom } = settings;
  return {
    label: label.slice(0, 120),
    width_px: size.width,
    height_px: size.height,
    rate_hz: known(frameRate) ?? 0,
    focus: focusOf(settings.focusMode),
    focus_mm: scaled(focusDistance, 1000),
    zoom_percent: scaled(zoom, 100),
  };
}

function focusOf(mode: string | undefined): Focus {
  if (mode === "manual") return "locked";
  return mode === "continuous" || mode === "single-shot" ? "automatic" : "unknown";
}

function known(value: number | undefined): number | null {
  return value !== undefined && Number.isFinite(value) && value > 0 ? value : null;
}

function scaled(value: number | undefined, factor: number): number | null {
  const there = known(value);
  return there === null ? null : Math.max(1, Math.min(Math.round(there * factor), 100_000));
}
