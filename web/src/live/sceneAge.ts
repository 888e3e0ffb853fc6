// Age of the 3-D scene, from the image index that it reports as drawn.

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

/** Number of remembered images: some seconds. */
const REMEMBERED = 256;
/** How far the scene may be ahead of this page's images, which skip. */
const AHEAD_AT_MOST = 90;

export class SceneAge {
  private readonly captured: { imageNumber: number; capturedAtMs: number }[] = [];
  private note: SceneNote | null = null;
  private changedAtMs = 0;
  private wasLive = false;

  /** Records an image received by this page. */
  image(imageNumber: number, capturedAtMs: number): void {
    const last = this.captured.at(-1);
    // A decreasing index means a new source: reports about the old one are ignored.
    if (last && imageNumber < last.imageNumber) this.forget();
    if (last?.imageNumber === imageNumber) return;
    this.captured.push({ imageNumber, capturedAtMs });
    if (this.captured.length > REMEMBERED) this.captured.shift();
  }

  /** Records the scene's report of what it has drawn. */
  drawn(note: SceneNote, nowMs: number): void {
    if (note.image_number !== this.note?.image_number) this.changedAtMs = nowMs;
    this.note = note;
  }

  forget(): void {
    this.captured.length = 0;
    this.note = null;
  }

  /** The scene is being reloaded: nothing is drawn yet. */
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
    // Connected, but nothing is drawn yet.
    if (!this.wasLive && (number === null || this.note?.connected !== true)) return { state: "loading" };
    return { state: "stale", imageNumber: number, ageMs };
  }

  /** Age of the drawn image: at least the time since the scene last changed; null if unknown. */
  private ageOf(imageNumber: number, nowMs: number): number | null {
    const newest = this.captured.at(-1);
    if (!newest || imageNumber > newest.imageNumber + AHEAD_AT_MOST) return null;
    // Images in between were skipped: the older neighbour bounds the age from above.
    const neighbour = this.captured.findLast((one) => one.imageNumber <= imageNumber);
    if (!neighbour) return null;
    return Math.max(nowMs - neighbour.capturedAtMs, nowMs - this.changedAtMs);
  }
}
