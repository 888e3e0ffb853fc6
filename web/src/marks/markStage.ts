// A picture that can be marked: the video, or a cut of the CT.
import type { MarkSurface, Point } from "../room/messages";
import type { Mark, Pointer } from "../room/roomState";
import type { PaintedMark, PaintedPointer, Pen } from "./paint";
import type { Size } from "./place";

export interface MarkStage {
  /** What a mark made now is made on; null while nothing can be marked. */
  readonly surface: MarkSurface | null;
  /** Calls `listener` when the picture has moved under its marks; returns a function that ends this. */
  onMove(listener: () => void): () => void;
  /** Whether a place of the stage (page pixels) is on the picture. */
  isOn(at: Point, stage: Size): boolean;
  /** The place on this surface, which may be of an earlier picture; clamped to the picture. Null without one. */
  locate(at: Point, stage: Size, surface: MarkSurface): Point | null;
  /** Returns how to paint a drawing; null if nothing of it is in this picture. */
  drawing(mark: Pick<Mark, "points" | "shape" | "plane">): ((pen: Pen, mark: PaintedMark) => void) | null;
  /** Returns how to paint a pointer; null if it is not in this picture. */
  pointer(pointer: Pick<Pointer, "at" | "plane">): ((pen: Pen, pointer: PaintedPointer) => void) | null;
}
