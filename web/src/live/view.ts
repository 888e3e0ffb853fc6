// State of the page at one moment, as every pane receives it.
import type { NumbersVerdict, VideoVerdict } from "./assess";
import type { DrawingBudget } from "./budget";
import type { PictureDelivery } from "./pictureDelivery";
import type { FirstMessage } from "./firstMessage";
import type { LinkState } from "./viewConnection";
import type { LiveMessage } from "./messages";
import type { SceneVerdict } from "./sceneAge";

/** Ages of everything displayed, in ms; null if nothing is. */
export interface Ages {
  pictureMs: number | null;
  numbersMs: number | null;
  sceneMs: number | null;
  /** Offset of the server's clock from the page's; null before the first comparison. */
  clockAheadMs: number | null;
}

export interface View {
  nowMs: number;
  link: LinkState;
  silentMs: number;
  /** State of the first message: before it, the page claims nothing. */
  firstMessage: FirstMessage;
  newest: LiveMessage | null;
  video: VideoVerdict;
  numbers: NumbersVerdict;
  /** How long there have been no numbers; null if there are, or never were. */
  untrackedMs: number | null;
  scene: SceneVerdict;
  ages: Ages;
  /** When figures or picture become too old without a newer one; null if neither is displayed. */
  expiresAtMs: number | null;
  /** State of this viewer's connection. */
  pictureDelivery: PictureDelivery;
  /** What this device can draw. */
  budget: DrawingBudget;
}

/** A drawn picture; it becomes visible with the next refresh. */
export interface PaintedImage {
  message: LiveMessage;
  receivedAtMs: number;
}

export function agesOf(
  video: VideoVerdict,
  numbers: NumbersVerdict,
  scene: SceneVerdict,
  clockAheadMs: number | null,
): Ages {
  return {
    pictureMs: video.ageMs,
    numbersMs: numbers.ageMs,
    sceneMs: "ageMs" in scene ? scene.ageMs : null,
    clockAheadMs,
  };
}

/** State that texts depend on; a change re-renders at once. */
export function keyOf({
  link,
  firstMessage,
  video,
  numbers,
  scene,
  newest,
  pictureDelivery: carried,
}: View): string {
  const videoKey = video.live ? "live" : video.cause;
  const unread = numbers.live ? null : numbers.unread;
  const numbersKey = numbers.live
    ? "live"
    : `${numbers.cause} ${unread?.headline.title.en ?? ""} ${unread?.headline.detail.en ?? ""}`;
  const problems = `${newest?.source.problem?.code ?? ""} ${newest?.process.problem?.code ?? ""}`;
  return [
    link,
    firstMessage,
    videoKey,
    numbersKey,
    scene.state,
    problems,
    newest?.source.state,
    newest?.alarms.revision,
    carried.choice,
  ].join("|");
}
