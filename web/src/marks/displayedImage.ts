// Index, time and size of the displayed image.
import type { View } from "../live/live";
import type { Moment } from "../room/messages";
import type { Size } from "./place";

export class DisplayedImage {
  size: Size = { width: 0, height: 0 };
  /** Null while no picture is displayed. */
  moment: Moment | null = null;

  update({ video }: Pick<View, "video">): void {
    if (!video.live) {
      this.moment = null;
      return;
    }
    const { image_number, captured_at_s, width_px, height_px } = video.snapshot;
    this.size = { width: width_px, height: height_px };
    this.moment = { image_number, captured_at_s };
  }
}
