// Turns pointer input into messages. Pure: time and what is marked are arguments.
import type { CutPlane, MarkSurface, Point, ClientMessage, Shape } from "../room/messages";
import { POINTER_GOES_AFTER_MS } from "../room/roomState";

export type Tool = "point" | Shape;

/** Drawn here and not yet confirmed by the server. */
interface LocalMark {
  key: number;
  shape: Shape;
  points: Point[];
  plane: CutPlane | null;
  /** Number of points that were sent. */
  sentPoints: number;
  endedAtMs: number | null;
}

const POINT_EVERY_MS = 45;
const EXTEND_EVERY_MS = 60;
/** Closer points are not sent. */
const MIN_STEP_PX = 2.5;
const MIN_STEP_MM = 0.3;
/** Limits of the server: points per message and per drawing. */
const MAX_A_MESSAGE = 40;
const MAX_A_DRAWING = 380;
const FORGOTTEN_AFTER_MS = 3000;

/** Position of this pointer as others see it. */
interface LocalPointer {
  at: Point;
  plane: CutPlane | null;
  goesAtMs: number;
}

export class MarksInput {
  readonly own: LocalMark[] = [];
  private key = 0;
  private pointedAtMs = -Infinity;
  private sentAtMs = -Infinity;
  private drawing: LocalMark | null = null;
  private surface: MarkSurface | null = null;
  /** Position that has not been sent yet. */
  private pending: { at: Point; surface: MarkSurface } | null = null;

  private localPointer: LocalPointer | null = null;

  constructor(private readonly send: (message: ClientMessage) => boolean) {}

  /** What the drawing in progress was started on; null if there is none. */
  get drawnOn(): MarkSurface | null {
    return this.drawing === null ? null : this.surface;
  }

  point(at: Point, surface: MarkSurface, nowMs: number): void {
    this.pending = { at, surface };
    this.flush(nowMs);
  }

  /** Call often: the final position of a pointer is sent when its interval has passed. */
  flush(nowMs: number): void {
    const { pending: rests, drawing } = this;
    if (rests !== null && nowMs - this.pointedAtMs >= POINT_EVERY_MS) {
      this.pointedAtMs = nowMs;
      this.pending = null;
      const { at, surface } = rests;
      const isSent = this.send({ point: { at, ...surface } });
      // What could not be sent is not shown here either.
      this.localPointer = isSent
        ? { at, plane: surface.plane ?? null, goesAtMs: nowMs + POINTER_GOES_AFTER_MS }
        : null;
    }
    if (drawing?.shape === "pen" && nowMs - this.sentAtMs >= EXTEND_EVERY_MS) this.sendPen(drawing, nowMs);
  }

  /** Null after the pointer has expired for others too. */
  pointerAt(nowMs: number): LocalPointer | null {
    return this.localPointer !== null && this.localPointer.goesAtMs > nowMs ? this.localPointer : null;
  }

  lift(): void {
    this.pending = null;
    this.localPointer = null;
    this.send({ lift: true });
  }

  down(shape: Shape, at: Point, surface: MarkSurface, nowMs: number): void {
    this.key += 1;
    this.drawing = {
      key: this.key,
      shape,
      points: shape === "pen" ? [at] : [at, at],
      plane: surface.plane ?? null,
      sentPoints: 0,
      endedAtMs: null,
    };
    this.surface = surface;
    this.own.push(this.drawing);
    this.sentAtMs = nowMs;
  }

  /** Draws a single point, at the origin of its plane. */
  dot(surface: MarkSurface, nowMs: number): void {
    this.down("pen", [0, 0], surface, nowMs);
    this.up(nowMs);
  }

  move(at: Point, nowMs: number): void {
    const { drawing } = this;
    if (drawing === null) return;
    if (drawing.shape !== "pen") {
      drawing.points[1] = at;
      return;
    }
    const last = drawing.points.at(-1);
    if (last !== undefined && Math.hypot(at[0] - last[0], at[1] - last[1]) < minStep(drawing)) return;
    drawing.points.push(at);
    this.flush(nowMs);
    if (drawing.points.length < MAX_A_DRAWING) return;
    // A line beyond the limit is split into several drawings.
    const { surface } = this;
    this.up(nowMs);
    if (surface !== null) this.down("pen", at, surface, nowMs);
  }

  up(nowMs: number): void {
    const { drawing, surface } = this;
    this.drawing = null;
    if (drawing === null || surface === null) return;
    drawing.endedAtMs = nowMs;
    if (drawing.shape === "pen") {
      this.sendPen(drawing, nowMs);
      return;
    }
    const [from, to] = drawing.points;
    const short = !from || !to || Math.hypot(to[0] - from[0], to[1] - from[1]) < 2 * minStep(drawing);
    // A minimal movement is no arrow.
    if (short) this.own.splice(this.own.indexOf(drawing), 1);
    else this.send({ draw: { key: drawing.key, shape: drawing.shape, points: [from, to], ...surface } });
  }

  undo(): void {
    this.send({ undo: true });
    this.own.length = 0;
  }

  clear(whose: "own" | "all"): void {
    this.send({ clear: whose });
    this.own.length = 0;
  }

  /** Removes drawings that were confirmed or never will be. */
  settle(hasCome: (own: LocalMark) => boolean, nowMs: number): void {
    const remaining = this.own.filter(
      (one) => !hasCome(one) && !(one.endedAtMs !== null && nowMs - one.endedAtMs > FORGOTTEN_AFTER_MS),
    );
    if (remaining.length < this.own.length) this.own.splice(0, this.own.length, ...remaining);
  }

  private sendPen(drawing: LocalMark, nowMs: number): void {
    this.sentAtMs = nowMs;
    const { key, shape, points } = drawing;
    while (drawing.sentPoints < points.length) {
      const part = points.slice(drawing.sentPoints, drawing.sentPoints + MAX_A_MESSAGE);
      const message: ClientMessage =
        drawing.sentPoints === 0 && this.surface !== null
          ? { draw: { key, shape, points: part, ...this.surface } }
          : { extend: { key, points: part } };
      // Points beyond the limit of a message are sent with the next one.
      if (!this.send(message)) return;
      drawing.sentPoints += part.length;
    }
  }
}

function minStep({ plane }: LocalMark): number {
  return plane === null ? MIN_STEP_PX : MIN_STEP_MM;
}
