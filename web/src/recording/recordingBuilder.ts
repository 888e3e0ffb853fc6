// A recording as the server reports it, for tests.
import type { Recording } from "./recordingText";

export function recording(changes: Partial<Recording> = {}): Recording {
  return {
    when: "manual",
    consent: { state: "given", answered_at: "2026-01-01T00:00:00Z", answered_by: "ito" },
    is_recording: true,
    name: "20260101T000000Z-0000.mcap",
    duration_s: 754.6,
    size_bytes: 1.24e9,
    images: 20_000,
    missing_images: 0,
    remaining_s: 11_000,
    problem: null,
    ...changes,
  };
}
