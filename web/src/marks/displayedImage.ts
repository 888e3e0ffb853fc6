// Which image stands on the page, with its time and its size; images are remembered until they are shown.
import type { View } from "../live/live";
import type { Moment } from "../room/messages";
import type { Size } from "./place";

const MAX_REMEMBERED = 60;

export class DisplayedImage {
  size: Size = { width: 0, height: 0 };
  /** Of the picture that stands on the page; null while none does. */
  moment: Moment | null = null;
  private readonly capturedAtS = new Map<number, number>();

  update({ newest, video }: View): void {
    const snapshot = newest?.snapshot ?? null;
    if (snapshot !== null) {
      this.size = { width: snapshot.width_px, height: snapshot.height_px };
      this.capturedAtS.set(snapshot.image_number, snapshot.captured_at_s);
      const [oldest] = this.capturedAtS.keys();
      if (this.capturedAtS.size > MAX_REMEMBERED && oldest !== undefined) this.capturedAtS.delete(oldest);
    }
    if (!video.live) {
      this.moment = null;
      return;
    }
    const captured_at_s = this.capturedAtS.get(video.imageNumber);
    if (captured_at_s !== undefined) this.moment = { image_number: video.imageNumber, captured_at_s };
  }
}
