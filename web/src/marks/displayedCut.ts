// The displayed cut of the CT and the marks near its plane.
import { frameOf, lpsFromPlane, type PixelGrid, type Vec2 } from "../operator/plan/slices/place";
import type { MarkSurface, Moment, Point } from "../room/messages";
import type { Mark, Pointer } from "../room/roomState";
import { outlineOf, patientFrom, placeOn, planeOf, pointOn, strokesOn } from "./cutMarks";
import type { MarkStage } from "./markStage";
import { paintLine, paintName, paintPointerAt } from "./paint";
import type { Size } from "./place";

interface Cut {
  grid: PixelGrid;
  ctId: string;
  /** The newest image when the cut was displayed. */
  moment: Moment;
}

export class DisplayedCut implements MarkStage {
  private readonly listeners = new Set<() => void>();
  private cut: Cut | null = null;

  onMove(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  /** Null while no cut of a CT is displayed. */
  update(cut: Cut | null): void {
    const hasMoved = cut?.grid !== this.cut?.grid || cut?.ctId !== this.cut?.ctId;
    this.cut = cut;
    if (hasMoved) for (const listener of this.listeners) listener();
  }

  get surface(): MarkSurface | null {
    return this.cut === null ? null : { ...this.cut.moment, plane: planeOf(this.cut.grid, this.cut.ctId) };
  }

  isOn([x, y]: Point, { width, height }: Size): boolean {
    return this.cut !== null && x >= 0 && y >= 0 && x <= width && y <= height;
  }

  locate([x, y]: Point, { width, height }: Size, { plane }: MarkSurface): Point | null {
    if (this.cut === null || plane === undefined || width <= 0 || height <= 0) return null;
    const { grid } = this.cut;
    const frame = frameOf(grid);
    const onCut: Vec2 = [
      frame.x + (clamped(x, width) / width) * frame.width,
      frame.y + (clamped(y, height) / height) * frame.height,
    ];
    return placeOn(plane, lpsFromPlane(grid, onCut));
  }

  drawing({
    shape,
    points,
    plane,
  }: Pick<Mark, "points" | "shape" | "plane">): ReturnType<MarkStage["drawing"]> {
    if (this.cut === null || plane?.ct_id !== this.cut.ctId) return null;
    const strokes = strokesOn(this.cut.grid, outlineOf(shape, points, plane));
    const nearest = strokes.toSorted((a, b) => b.strength - a.strength)[0];
    const at = nearest?.points[0];
    if (nearest === undefined || at === undefined) return null;
    return (pen, mark) => {
      const onStage = this.placement(pen.stage);
      for (const one of strokes) {
        paintLine(pen, mark.seat, mark.strength * one.strength, one.points.map(onStage));
      }
      paintName(pen, { ...mark, strength: mark.strength * nearest.strength }, onStage(at));
    };
  }

  pointer({ at, plane }: Pick<Pointer, "at" | "plane">): ReturnType<MarkStage["pointer"]> {
    if (this.cut === null || plane?.ct_id !== this.cut.ctId) return null;
    const point = patientFrom(plane, at);
    const near = point === null ? null : pointOn(this.cut.grid, point);
    if (near === null) return null;
    return (pen, pointer) => {
      paintPointerAt(pen, pointer, this.placement(pen.stage)(near.at), near.strength);
    };
  }

  /** From mm of the cut's plane to page pixels of a stage of this size. */
  private placement({ width, height }: Size): (at: Vec2) => Point {
    const frame = this.cut === null ? { x: 0, y: 0, width: 1, height: 1 } : frameOf(this.cut.grid);
    return ([x, y]) => [((x - frame.x) / frame.width) * width, ((y - frame.y) / frame.height) * height];
  }
}

function clamped(value: number, max: number): number {
  return Math.min(Math.max(value, 0), max);
}
