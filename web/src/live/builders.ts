// Truth for tests: messages as the server sends them.
import type { Situation, Taken } from "./assess";
import type { AlarmsMessage, LiveMessage, SnapshotMessage } from "./messages";

export function snapshot(changes: Partial<SnapshotMessage> = {}): SnapshotMessage {
  return {
    image_number: 7,
    captured_at_s: 100,
    age_ms: 20,
    width_px: 1280,
    height_px: 720,
    camera_calibrated: true,
    registered_by: "rehearsal",
    channel_name: "L3 left",
    markers: [
      { name: "drill", sighting: { kind: "unseen", reason: "SCORE_TOO_LOW", best_score_ratio: 0.4 } },
    ],
    tools: [
      {
        name: "drill",
        marker: "drill",
        pose: { kind: "absent", reason: "MARKER_UNSEEN" },
        deviation: {
          kind: "deviation",
          entry_offset_mm: 1,
          angle_deg: 2,
          depth_mm: 3,
          remaining_mm: 4,
          tip_offset_mm: 5,
        },
      },
    ],
    stage_ms: {},
    skipped_images: 0,
    ...changes,
  };
}

export function alarms(changes: Partial<AlarmsMessage> = {}): AlarmsMessage {
  return { revision: 0, sound: "silent", sound_number: 0, pause_left_s: 0, alarms: [], ...changes };
}

export function message(changes: Partial<LiveMessage> = {}): LiveMessage {
  return {
    sequence: 7,
    sent_at_s: 100.02,
    source: { name: "rehearsal", state: "running", trouble: null, images: 8, skipped_images: 0, rate_hz: 30 },
    process: { state: "running", restarts: 0, trouble: null },
    snapshot: snapshot(),
    alarms: alarms(),
    ...changes,
  };
}

export function taken(capturedAtMs: number, changes: Partial<SnapshotMessage> = {}): Taken {
  return { snapshot: snapshot(changes), capturedAtMs, receivedAtMs: capturedAtMs + 20 };
}

/** All well at time 1000 ms: an image grabbed at 960. */
export function situation(changes: Partial<Situation> = {}): Situation {
  return {
    link: "open",
    hidden: false,
    heardAtMs: 980,
    newest: message(),
    numbers: taken(960),
    picture: taken(960),
    limits: { pose_stale_after_ms: 150, video_stale_after_ms: 500, scene_stale_after_ms: 500 },
    ...changes,
  };
}

export function bytes(header: unknown, jpeg: number[] = [], headerBytes?: number): ArrayBuffer {
  const text = new TextEncoder().encode(typeof header === "string" ? header : JSON.stringify(header));
  const buffer = new ArrayBuffer(4 + text.length + jpeg.length);
  new DataView(buffer).setUint32(0, headerBytes ?? text.length, true);
  new Uint8Array(buffer).set(text, 4);
  new Uint8Array(buffer).set(jpeg, 4 + text.length);
  return buffer;
}
