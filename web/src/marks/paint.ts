// Paints pointers and drawings with a dark outline, so that they are visible on any picture.
import type { Point, Shape } from "../room/messages";
import type { Mark, Pointer } from "../room/roomState";
import { colourOf } from "./colours";
import type { Size } from "./place";

const CASE = "#05090ce6";

export interface PaintedMark extends Pick<Mark, "seat" | "name" | "shape"> {
  /** Opacity: 1 when new, less before it expires. */
  strength: number;
  /** Shown after the name; may be empty. */
  age: string;
}

export type PaintedPointer = Pick<Pointer, "seat" | "name">;

export interface Pen {
  context: CanvasRenderingContext2D;
  /** Size of the stage: text grows with its width, to be read from 3 m. */
  stage: Size;
}

/** Paints a mark whose points are at these places of the stage. */
export function paintShape(pen: Pen, mark: PaintedMark, points: readonly Point[]): void {
  const [first] = points;
  if (first === undefined) return;
  const line = lineWidth(pen);
  stroke(pen, mark.seat, mark.strength, (context) => {
    trace(context, mark.shape, points, line);
  });
  paintName(pen, mark, first);
}

/** Paints a line along these places of the stage; one place is painted as a dot. */
export function paintLine(pen: Pen, seat: number, strength: number, points: readonly Point[]): void {
  stroke(pen, seat, strength, (context) => {
    trace(context, "pen", points, 0);
  });
}

/** Name and age of a mark, beside this place of the stage. */
export function paintName(pen: Pen, { name, age, seat, strength }: PaintedMark, at: Point): void {
  pen.context.globalAlpha = strength;
  label(pen, age === "" ? name : `${name} · ${age}`, at, seat);
  pen.context.globalAlpha = 1;
}

function lineWidth({ stage }: Pen): number {
  return Math.max(3.5, stage.width * 0.0045);
}

function stroke(
  pen: Pen,
  seat: number,
  strength: number,
  path: (context: CanvasRenderingContext2D) => void,
): void {
  const { context } = pen;
  const line = lineWidth(pen);
  context.globalAlpha = strength;
  context.lineCap = context.lineJoin = "round";
  for (const [style, extra] of [
    [CASE, line * 0.9],
    [colourOf(seat), 0],
  ] as const) {
    context.strokeStyle = style;
    context.lineWidth = line + extra;
    context.beginPath();
    path(context);
    context.stroke();
  }
  context.globalAlpha = 1;
}

/** Paints a pointer at this place of the stage. */
export function paintPointerAt(pen: Pen, pointer: PaintedPointer, at: Point, strength = 1): void {
  const { context } = pen;
  const radius = Math.max(8, pen.stage.width * 0.011);
  context.globalAlpha = strength;
  for (const [style, size] of [
    [CASE, radius * 1.45],
    ["#ffffff", radius * 1.2],
    [CASE, radius],
    [colourOf(pointer.seat), radius * 0.82],
  ] as const) {
    context.fillStyle = style;
    context.beginPath();
    context.arc(at[0], at[1], size, 0, 2 * Math.PI);
    context.fill();
  }
  label(pen, pointer.name, [at[0] + radius, at[1] - radius], pointer.seat);
  context.globalAlpha = 1;
}

function trace(
  context: CanvasRenderingContext2D,
  shape: Shape,
  points: readonly Point[],
  line: number,
): void {
  const [from, to] = points;
  if (from === undefined) return;
  if (shape === "circle" && to !== undefined) {
    context.arc(from[0], from[1], Math.hypot(to[0] - from[0], to[1] - from[1]), 0, 2 * Math.PI);
    return;
  }
  context.moveTo(from[0], from[1]);
  // A single point is painted as a dot.
  for (const [x, y] of points.length > 1 ? points.slice(1) : points) context.lineTo(x, y);
  if (shape !== "arrow" || to === undefined) return;
  const way = Math.atan2(to[1] - from[1], to[0] - from[0]);
  for (const turn of [2.6, -2.6]) {
    context.moveTo(to[0], to[1]);
    context.lineTo(to[0] + 6 * line * Math.cos(way + turn), to[1] + 6 * line * Math.sin(way + turn));
  }
}

/** The name in a dark box above the position, within the stage. */
function label(pen: Pen, text: string, [x, y]: Point, seat: number): void {
  const { context } = pen;
  const { width } = pen.stage;
  const size = Math.min(Math.max(14, width * 0.019), 38);
  context.font = `650 ${size}px system-ui, sans-serif`;
  context.textBaseline = "middle";
  const box = { width: context.measureText(text).width + size, height: size * 1.5 };
  const left = Math.min(Math.max(x + size * 0.5, 2), Math.max(2, width - box.width - 2));
  const top = Math.max(2, y - box.height - size * 0.4);
  context.fillStyle = CASE;
  context.fillRect(left, top, box.width, box.height);
  context.fillStyle = colourOf(seat);
  context.fillRect(left, top, size * 0.28, box.height);
  context.fillStyle = "#ffffff";
  context.fillText(text, left + size * 0.65, top + box.height / 2);
}
