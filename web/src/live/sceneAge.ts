// How old the 3-D scene is, from the image number that it says it has drawn.

export type SceneVerdict =
  | { state: "live"; imageNumber: number; behindImages: number; ageMs: number }
  | { state: "loading" }
  | { state: "off" }
  | { state: "stale"; imageNumber: number | null; ageMs: number | null };

export interface SceneNote {
  kind: "coaxial-scene";
  image_number: number | null;
  connected: boolean;
  /** Whether it is drawn without a graphics card. */
  drawn_by_processor: boolean;
}

export function isSceneNote(value: unknown): value is SceneNote {
  if (typeof value !== "object" || value === null) return false;
  const note = value as Record<string, unknown>;
  return (
    note["kind"] === "coaxial-scene" &&
    typeof note["connected"] === "boolean" &&
    typeof note["drawn_by_processor"] === "boolean" &&
    (note["image_number"] === null || Number.isInteger(note["image_number"]))
  );
}

/** How many images are remembered: some seconds' worth. */
const REMEMBERED = 256;
/** The scene may run ahead of this page's images, which skip; not by more than this. */
const AHEAD_AT_MOST = 90;

export class SceneAge {
  private readonly captured: { imageNumber: number; capturedAtMs: number }[] = [];
  private note: SceneNote | null = null;
  private changedAtMs = 0;
  private wasLive = false;

  /** An image that this page has received. */
  image(imageNumber: number, capturedAtMs: number): void {
    const last = this.captured.at(-1);
    // Numbers that run backwards come from a new source: what the scene says of the old one counts no more.
    if (last && imageNumber < last.imageNumber) this.forget();
    if (last?.imageNumber === imageNumber) return;
    this.captured.push({ imageNumber, capturedAtMs });
    if (this.captured.length > REMEMBERED) this.captured.shift();
  }

  /** What the scene says it has drawn. */
  drawn(note: SceneNote, nowMs: number): void {
    if (note.image_number !== this.note?.image_number) this.changedAtMs = nowMs;
    this.note = note;
  }

  forget(): void {
    this.captured.length = 0;
    this.note = null;
  }

  /** The scene is loaded anew: nothing of it is drawn yet. */
  reload(): void {
    this.note = null;
    this.wasLive = false;
  }

  verdict(nowMs: number, staleAfterMs: number): SceneVerdict {
    const number = this.note?.image_number ?? null;
    const ageMs = number === null ? null : this.ageOf(number, nowMs);
    const newest = this.captured.at(-1);
    if (number !== null && ageMs !== null && newest && this.note?.connected && ageMs <= staleAfterMs) {
      this.wasLive = true;
      const behindImages = Math.max(newest.imageNumber - number, 0);
      return { state: "live", imageNumber: number, behindImages, ageMs };
    }
    // Connected before anything is drawn, it is still on its way.
    if (!this.wasLive && (number === null || this.note?.connected !== true)) return { state: "loading" };
    return { state: "stale", imageNumber: number, ageMs };
  }

  /** Age of the image drawn: at least the time since the scene last changed; null when it is unknown. */
  private ageOf(imageNumber: number, nowMs: number): number | null {
    const newest = this.captured.at(-1);
    if (!newest || imageNumber > newest.imageNumber + AHEAD_AT_MOST) return null;
    // The images between two that came were skipped: the older neighbour bounds the age from above.
    const neighbour = this.captured.findLast((one) => one.imageNumber <= imageNumber);
    if (!neighbour) return null;
    return Math.max(nowMs - neighbour.capturedAtMs, nowMs - this.changedAtMs);
  }
}
