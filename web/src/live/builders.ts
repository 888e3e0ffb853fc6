// Messages for tests, as the server sends them.
import type { Situation, ReceivedImage } from "./assess";
import { alarms } from "./alarmBuilders";
import { assessment, headline } from "./figureBuilders";
import type {
  BullseyeMessage,
  ChannelMessage,
  JudgementMessage,
  LiveMessage,
  SnapshotMessage,
} from "./messages";

export function snapshot(changes: Partial<SnapshotMessage> = {}): SnapshotMessage {
  return {
    image_number: 7,
    captured_at_s: 100,
    width_px: 1280,
    height_px: 720,
    camera_calibrated: true,
    registered_by: "rehearsal",
    anchored_to: "camera",
    reference: null,
    channel_name: "L3 left",
    channel: channel(),
    withheld: null,
    vertebra: { kind: "absent", reason: "NOT_REGISTERED" },
    motion: {
      motion_detected_by: "not-at-all",
      camera_moved: false,
      reference_moved: false,
      scene: "unsure",
    },
    markers: [
      {
        name: "drill",
        unseen_s: 0.2,
        sighting: { kind: "unseen", reason: "SCORE_TOO_LOW", best_score_ratio: 0.4 },
      },
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
          entry_lateral_mm: 0.6,
          entry_cranial_mm: 0.8,
          transverse_deg: 1.5,
          sagittal_deg: -1.5,
          angle_medial_deg: 1.5,
          angle_cranial_deg: -1.5,
        },
        judgement: judgement(),
        assessment: assessment(),
        along: along(),
      },
    ],
    displayed_tool: "drill",
    stage_ms: {},
    skipped_images: 0,
    ...changes,
  };
}

/** Straight forward in the patient, 40 mm long, with a screw. */
export function channel(changes: Partial<ChannelMessage> = {}): ChannelMessage {
  return {
    entry_in_vertebra_mm: [14, 12, 0],
    target_in_vertebra_mm: [14, -28, 0],
    radius_mm: 4,
    screw: { diameter_mm: 6.5, length_mm: 45 },
    ct_id: "ct-1",
    placed_screws: [],
    ...changes,
  };
}

/** 1.8 mm from the medial wall, with a screw that would stay within. */
export function judgement(changes: Partial<JudgementMessage> = {}): JudgementMessage {
  const place = {
    kind: "nearest" as const,
    wall: "medial" as const,
    point_in_vertebra_mm: [0, 0, 0],
  };
  return {
    kind: "judgement",
    clearance: {
      against: "bone",
      now: { ...place, clearance_mm: 1.8, grade: "A" },
      lookahead: { ...place, clearance_mm: 0.9, grade: "A" },
      at_end: { ...place, clearance_mm: -0.4, grade: "B" },
      channel: { ...place, clearance_mm: 0.2, grade: "A" },
      past_planned_mm: -4,
    },
    probability: {
      now_ratio: 0,
      lookahead_ratio: 0.03,
      at_end_ratio: 0.12,
      at_end_grade_ratio: { A: 0.88, B: 0.12, C: 0, D: 0, E: 0 },
      past_planned_ratio: 0,
    },
    spread: {
      tip_ellipsoid_mm: [
        [1, 0, 0],
        [0, 0.5, 0],
        [0, 0, 0.5],
      ],
      cone_95_deg: 1,
      tip_sd_mm: 0.35,
      sd_angle_deg: 0.4,
      sd_depth_mm: 0.2,
      sd_at_entry_mm: 0.3,
    },
    certain: { enough: true, entry_95_mm: 0.7, isthmus_95_mm: 0.8, tolerance_mm: 2, tolerance_deg: 6.3 },
    ...changes,
  };
}

/** Beside the axis, rotated slightly to the right. */
function along(changes: Partial<BullseyeMessage> = {}): BullseyeMessage {
  return {
    tip_mm: [1, -0.5],
    at_entry_mm: [0.6, 0.8],
    at_target_mm: [2, -3],
    nearest_mm: [2.6, -0.5],
    tip_half_axes_95_mm: [
      [0.5, 0],
      [0, 0.3],
    ],
    medial_is_right: true,
    channel_radius_mm: 4,
    channel_length_mm: 40,
    drill_radius_mm: 2,
    reach_mm: 8,
    ...changes,
  };
}

export function message(changes: Partial<LiveMessage> = {}): LiveMessage {
  return {
    sequence: 7,
    sent_at_s: 100.02,
    image_age_ms: 20,
    shown_scale_ratio: 1,
    source: {
      name: "rehearsal",
      state: "running",
      problem: null,
      images: 8,
      skipped_images: 0,
      rate_hz: 30,
      camera: null,
    },
    process: { state: "running", restarts: 0, problem: null },
    snapshot: snapshot(),
    headline: headline(),
    alarms: alarms(),
    proposed_channel: null,
    ...changes,
  };
}

export function receivedImage(capturedAtMs: number, changes: Partial<SnapshotMessage> = {}): ReceivedImage {
  return {
    snapshot: snapshot(changes),
    headline: headline(),
    capturedAtMs,
    receivedAtMs: capturedAtMs + 20,
  };
}

/** A good state at time 1000 ms, with an image captured at 960. */
export function situation(changes: Partial<Situation> = {}): Situation {
  return {
    link: "open",
    hidden: false,
    everReceived: true,
    waitingSinceMs: 0,
    lastPictureAtMs: 960,
    canvasSinceMs: null,
    lastReceivedAtMs: 980,
    newest: message(),
    numbers: receivedImage(960),
    picture: receivedImage(960),
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
