// The figures of one image, or why there are none. Tool, limits and texts were decided by the server, as in the video.
import type {
  BullseyeMessage,
  AssessmentMessage,
  DeviationMessage,
  HeadlineMessage,
  SnapshotMessage,
} from "./messages";

export interface Reading {
  known: true;
  tool: string;
  deviation: DeviationMessage;
  assessment: AssessmentMessage;
  along: BullseyeMessage | null;
  lagMs: number;
  headline: HeadlineMessage;
}

export interface Unread {
  known: false;
  headline: HeadlineMessage;
}

export function readingOf(snapshot: SnapshotMessage, headline: HeadlineMessage): Reading | Unread {
  const tool = snapshot.tools.find(({ name }) => name === snapshot.displayed_tool);
  if (tool?.assessment.kind !== "assessment" || tool.deviation.kind !== "deviation") {
    return { known: false, headline };
  }
  return {
    known: true,
    tool: tool.name,
    deviation: tool.deviation,
    assessment: tool.assessment,
    along: tool.along,
    lagMs: tool.pose.kind === "tool" ? tool.pose.lag_ms : 0,
    headline,
  };
}
