// The displayed video image and the marks on it.
import type { View } from "../live/live";
import type { MarkSurface, Moment, Point } from "../room/messages";
import type { Mark, Pointer } from "../room/roomState";
import type { MarkStage } from "./markStage";
import { paintPointerAt, paintShape } from "./paint";
import { isOnImage, onImage, onStage, placed, type Size } from "./place";

export class DisplayedImage implements MarkStage {
  size: Size = { width: 0, height: 0 };
  /** Null while no picture is displayed. */
  moment: Moment | null = null;

  get surface(): MarkSurface | null {
    return this.moment;
  }

  update({ video }: Pick<View, "video">): void {
    if (!video.live) {
      this.moment = null;
      return;
    }
    const { image_number, captured_at_s, width_px, height_px } = video.snapshot;
    this.size = { width: width_px, height: height_px };
    this.moment = { image_number, captured_at_s };
  }

  /** Marks on the video stay where they are in the image. */
  onMove(): () => void {
    return () => undefined;
  }

  isOn(at: Point, stage: Size): boolean {
    const placement = placed(this.size, stage);
    return placement !== null && isOnImage(at, placement);
  }

  locate(at: Point, stage: Size, { plane }: MarkSurface): Point | null {
    const placement = placed(this.size, stage);
    return placement === null || plane !== undefined ? null : onImage(at, placement);
  }

  drawing({ points, plane }: Pick<Mark, "points" | "plane">): ReturnType<MarkStage["drawing"]> {
    if (plane !== null) return null;
    return (pen, mark) => {
      const placement = placed(this.size, pen.stage);
      if (placement === null) return;
      paintShape(
        pen,
        mark,
        points.map((one) => onStage(one, placement)),
      );
    };
  }

  pointer({ at, plane }: Pick<Pointer, "at" | "plane">): ReturnType<MarkStage["pointer"]> {
    if (plane !== null) return null;
    return (pen, pointer) => {
      const placement = placed(this.size, pen.stage);
      if (placement !== null) paintPointerAt(pen, pointer, onStage(at, placement));
    };
  }
}
