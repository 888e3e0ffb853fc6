// Messages of `/ws/camera`; see `server/stream/phone/messages.py`.

export interface Problem {
  code: string;
  message: string;
  remedy: string;
}

export interface Welcome {
  width_px: number;
  height_px: number;
  rate_hz: number;
  quality_ratio: number;
  part_bytes: number;
  lock_focus: boolean;
  focus_mm: number | null;
}

export interface Note {
  ping: number;
  credit: number;
  images: number;
  rate_hz: number;
  delay_ms: number | null;
  clock_error_ms: number | null;
  source_state: "opening" | "running" | "reconnecting" | "ended" | null;
  problem: Problem | null;
}

export type ServerMessage = { welcome: Welcome } | { note: Note } | { rejected: Problem };

export type Focus = "locked" | "automatic" | "unknown";

export interface CameraFacts {
  label: string;
  width_px: number;
  height_px: number;
  rate_hz: number;
  focus: Focus;
  focus_mm: number | null;
  zoom_percent: number | null;
}

export interface FrameTime {
  captured_ms: number;
  clock: "capture" | "presentation";
}
