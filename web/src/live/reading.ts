// The surgeon's numbers out of one image's message, or why there are none. The burned-in panel goes by the
// same rule: the first tool whose numbers are known; without one, the first reason.
import type {
  AbsentReason,
  AlongMessage,
  DeviationMessage,
  JudgementMessage,
  MarkerMessage,
  SnapshotMessage,
  ToolStateMessage,
  UnseenReason,
} from "./messages";

export interface Reading {
  known: true;
  tool: string;
  deviation: DeviationMessage;
  judgement: JudgementMessage | null;
  along: AlongMessage | null;
  tipSdMm: number | null;
  lagMs: number;
}

export interface Unread {
  known: false;
  reason: AbsentReason;
  marker: string | null;
  unseen: UnseenReason | null;
}

export function readingOf(snapshot: SnapshotMessage): Reading | Unread {
  for (const tool of snapshot.tools) {
    if (tool.deviation.kind === "deviation" && isWhole(tool.deviation)) {
      return {
        known: true,
        tool: tool.name,
        deviation: tool.deviation,
        judgement: tool.judgement.kind === "judgement" ? tool.judgement : null,
        along: tool.along,
        tipSdMm: tipSdMm(tool),
        lagMs: tool.pose.kind === "tool" ? tool.pose.lag_ms : 0,
      };
    }
  }
  for (const tool of snapshot.tools) {
    if (tool.deviation.kind === "absent") return unread(snapshot, tool.deviation.reason, tool.marker);
  }
  if (!snapshot.markers.some((marker) => marker.sighting.kind === "seen")) {
    return unread(snapshot, "MARKER_UNSEEN", snapshot.markers[0]?.name ?? null);
  }
  return unread(snapshot, snapshot.camera_calibrated ? "TOOL_NOT_DEFINED" : "CAMERA_NOT_CALIBRATED", null);
}

/** The entry offset alone may be null: the drill lies across the channel. */
function isWhole(deviation: DeviationMessage): boolean {
  return [deviation.angle_deg, deviation.depth_mm, deviation.remaining_mm].every(Number.isFinite);
}

function tipSdMm(tool: ToolStateMessage): number | null {
  return tool.pose.kind === "tool" ? tool.pose.tip_sd_mm : null;
}

function unread(snapshot: SnapshotMessage, reason: AbsentReason, name: string | null): Unread {
  const marker = snapshot.markers.find((one) => one.name === name);
  const unseen = reason === "MARKER_UNSEEN" && marker ? unseenReason(marker) : null;
  return { known: false, reason, marker: name, unseen };
}

function unseenReason(marker: MarkerMessage): UnseenReason | null {
  return marker.sighting.kind === "unseen" ? marker.sighting.reason : null;
}
