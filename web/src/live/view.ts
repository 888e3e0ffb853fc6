// What the page knows of one moment, as every pane gets it.
import type { NumbersVerdict, VideoVerdict } from "./assess";
import type { DrawingBudget } from "./budget";
import type { PictureDelivery } from "./pictureDelivery";
import type { FirstMessage } from "./firstMessage";
import type { LinkState } from "./viewConnection";
import type { LiveMessage } from "./messages";
import type { SceneVerdict } from "./sceneAge";

/** The true age of everything that is displayed, in ms; null where nothing is. */
export interface Ages {
  pictureMs: number | null;
  numbersMs: number | null;
  sceneMs: number | null;
  /** By how much the server's clock is ahead of the page's; null before they were compared. */
  clockAheadMs: number | null;
}

export interface View {
  nowMs: number;
  link: LinkState;
  silentMs: number;
  /** Since the page was loaded; what it claims before that is nothing. */
  firstMessage: FirstMessage;
  newest: LiveMessage | null;
  video: VideoVerdict;
  numbers: NumbersVerdict;
  /** How long there have been no numbers; null while there are, or when there never were. */
  untrackedMs: number | null;
  scene: SceneVerdict;
  ages: Ages;
  /** When figures or picture will be too old, if nothing newer comes; null when neither stands. */
  expiresAtMs: number | null;
  /** What this viewer's line carries. */
  pictureDelivery: PictureDelivery;
  /** What this device can draw. */
  budget: DrawingBudget;
}

/** A picture that was drawn; it is seen with the next image of the screen. */
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

/** What the texts of the page depend on; a change of it is rendered at once. */
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
