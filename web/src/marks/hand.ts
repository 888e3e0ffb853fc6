// A hand that points and draws: from where it goes to what is said. Pure: time and image are handed in.
import type { Moment, Point, Said, Shape } from "../room/messages";
import { POINTER_GOES_AFTER_MS } from "../room/roomState";

export type Tool = "point" | Shape;

/** What was drawn here and has not come back from the server yet. */
export interface Own {
  key: number;
  shape: Shape;
  points: Point[];
  /** How many of them were said. */
  told: number;
  endedAtMs: number | null;
}

const POINT_EVERY_MS = 45;
const EXTEND_EVERY_MS = 60;
/** Nearer points say nothing; in image pixels. */
const MIN_STEP_PX = 2.5;
/** As the server takes them: points to a message, points to a drawing. */
const MAX_A_MESSAGE = 50;
const MAX_A_DRAWING = 380;
const FORGOTTEN_AFTER_MS = 3000;

/** Where the others see this hand point. */
export interface Pointed {
  at: Point;
  goesAtMs: number;
}

export class Hand {
  readonly own: Own[] = [];
  private key = 0;
  private pointedAtMs = -Infinity;
  private saidAtMs = -Infinity;
  private drawing: Own | null = null;
  private moment: Moment | null = null;
  /** Where the hand is, while that was not said. */
  private rests: { at: Point; moment: Moment } | null = null;

  private told: Pointed | null = null;

  constructor(private readonly say: (said: Said) => boolean) {}

  point(at: Point, moment: Moment, nowMs: number): void {
    this.rests = { at, moment };
    this.flush(nowMs);
  }

  /** To be called often: where a hand came to rest is said too, when its time has come. */
  flush(nowMs: number): void {
    const { rests, drawing } = this;
    if (rests !== null && nowMs - this.pointedAtMs >= POINT_EVERY_MS) {
      this.pointedAtMs = nowMs;
      this.rests = null;
      const isTold = this.say({ point: { at_px: rests.at, ...rests.moment } });
      // What nobody was told of is not shown here either.
      this.told = isTold ? { at: rests.at, goesAtMs: nowMs + POINTER_GOES_AFTER_MS } : null;
    }
    if (drawing?.shape === "pen" && nowMs - this.saidAtMs >= EXTEND_EVERY_MS) this.tellPen(drawing, nowMs);
  }

  /** Null once it is gone for the others, too. */
  pointed(nowMs: number): Pointed | null {
    return this.told !== null && this.told.goesAtMs > nowMs ? this.told : null;
  }

  lift(): void {
    this.rests = null;
    this.told = null;
    this.say({ lift: true });
  }

  down(shape: Shape, at: Point, moment: Moment, nowMs: number): void {
    this.key += 1;
    this.drawing = {
      key: this.key,
      shape,
      points: shape === "pen" ? [at] : [at, at],
      told: 0,
      endedAtMs: null,
    };
    this.moment = moment;
    this.own.push(this.drawing);
    this.saidAtMs = nowMs;
  }

  move(at: Point, nowMs: number): void {
    const { drawing } = this;
    if (drawing === null) return;
    if (drawing.shape !== "pen") {
      drawing.points[1] = at;
      return;
    }
    const last = drawing.points.at(-1);
    if (last !== undefined && Math.hypot(at[0] - last[0], at[1] - last[1]) < MIN_STEP_PX) return;
    drawing.points.push(at);
    this.flush(nowMs);
    if (drawing.points.length < MAX_A_DRAWING) return;
    // A line without end is several drawings.
    const { moment } = this;
    this.up(nowMs);
    if (moment !== null) this.down("pen", at, moment, nowMs);
  }

  up(nowMs: number): void {
    const { drawing, moment } = this;
    this.drawing = null;
    if (drawing === null || moment === null) return;
    drawing.endedAtMs = nowMs;
    if (drawing.shape === "pen") {
      this.tellPen(drawing, nowMs);
      return;
    }
    const [from, to] = drawing.points;
    const short = !from || !to || Math.hypot(to[0] - from[0], to[1] - from[1]) < 2 * MIN_STEP_PX;
    // A slip of the finger is no arrow.
    if (short) this.own.splice(this.own.indexOf(drawing), 1);
    else this.say({ draw: { key: drawing.key, shape: drawing.shape, points_px: [from, to], ...moment } });
  }

  undo(): void {
    this.say({ undo: true });
    this.own.length = 0;
  }

  clear(whose: "own" | "all"): void {
    this.say({ clear: whose });
    this.own.length = 0;
  }

  /** Lets go of what has come back, or never will. */
  settle(hasCome: (own: Own) => boolean, nowMs: number): void {
    const kept = this.own.filter(
      (one) => !hasCome(one) && !(one.endedAtMs !== null && nowMs - one.endedAtMs > FORGOTTEN_AFTER_MS),
    );
    if (kept.length < this.own.length) this.own.splice(0, this.own.length, ...kept);
  }

  private tellPen(drawing: Own, nowMs: number): void {
    this.saidAtMs = nowMs;
    const { key, shape, points } = drawing;
    while (drawing.told < points.length) {
      const points_px = points.slice(drawing.told, drawing.told + MAX_A_MESSAGE);
      const said: Said =
        drawing.told === 0 && this.moment !== null
          ? { draw: { key, shape, points_px, ...this.moment } }
          : { extend: { key, points_px } };
      // A line that is full takes the rest with the next points.
      if (!this.say(said)) return;
      drawing.told += points_px.length;
    }
  }
}
