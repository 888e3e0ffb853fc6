// The canvas of marks, repainted when something moved, came or expired.
import { prefersReducedMotion } from "./reducedMotion";
import type { MarksInput } from "./marksInput";
import type { MarkStage } from "./markStage";
import type { Pen } from "./paint";
import type { Size } from "./place";
import type { Mark, RoomState } from "../room/roomState";

/** Start of the fade before a drawing expires. */
const FADES_FOR_MS = 5000;
const AGAIN_AFTER_MS = 100;

export class MarksCanvas {
  private waiting = false;
  private isEmpty = false;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly stage: MarkStage,
    private readonly room: () => RoomState,
    private readonly input: () => MarksInput | null,
    private readonly ageText: (seconds: number) => string,
  ) {}

  get size(): Size {
    return { width: this.canvas.clientWidth, height: this.canvas.clientHeight };
  }

  /** Paints with the next animation frame. */
  requestPaint(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.paint();
    });
  }

  stop(): void {
    clearTimeout(this.timer);
    this.waiting = true;
  }

  private paint(): void {
    clearTimeout(this.timer);
    const { canvas, stage } = this;
    const context = canvas.getContext("2d");
    if (context === null) return;
    const state = this.room();
    const nowMs = performance.now();
    const you = state.you?.seat ?? 0;
    const local = this.input()?.own ?? [];
    this.input()?.settle(
      (one) =>
        state.marks.some(
          (mark) => mark.key === `${you}-${one.key}` && mark.points.length >= one.points.length,
        ),
      nowMs,
    );
    const drawings = state.marks.flatMap((one) => painted(one, stage.drawing(one)));
    const own = local.flatMap((one) => painted(one, stage.drawing(one)));
    const pointers = state.pointers
      .filter((one) => one.seat !== you)
      .flatMap((one) => painted(one, stage.pointer(one)));
    const pointed = this.input()?.pointerAt(nowMs) ?? null;
    const paintOwn = pointed === null ? null : stage.pointer(pointed);
    canvas.dataset["marks"] = String(drawings.length);
    canvas.dataset["pointers"] = String(pointers.length);
    canvas.dataset["pointed"] = String(paintOwn !== null);
    const isEmpty = drawings.length + own.length + pointers.length === 0 && paintOwn === null;
    // Clearing an empty canvas would still make the browser compose the whole picture.
    if (isEmpty && this.isEmpty) return;
    this.isEmpty = isEmpty;
    canvas.dataset["empty"] = String(isEmpty);
    this.fit(context);
    const pen: Pen = { context, stage: this.size };
    const name = state.you?.name ?? "";
    for (const { one, paint } of drawings) {
      // Local input is ahead of the server and is painted instead of its echo.
      if (local.some(({ key }) => one.key === `${you}-${key}`)) continue;
      paint(pen, { ...one, strength: strengthOf(one, nowMs), age: this.ageOf(one, nowMs) });
    }
    for (const { one, paint } of own) paint(pen, { ...one, seat: you, name, strength: 1, age: "" });
    for (const { one, paint } of pointers) paint(pen, one);
    paintOwn?.(pen, { seat: you, name });
    if (!isEmpty) {
      this.timer = setTimeout(() => {
        this.requestPaint();
      }, AGAIN_AFTER_MS);
    }
  }

  private ageOf(mark: Mark, nowMs: number): string {
    const seconds = Math.floor((nowMs - mark.madeAtMs) / 1000);
    return seconds < 1 ? "" : this.ageText(seconds);
  }

  /** Matches the canvas to the screen's pixels and clears it. */
  private fit(context: CanvasRenderingContext2D): void {
    const { canvas } = this;
    const ratio = Math.min(devicePixelRatio, 2);
    const width = Math.round(canvas.clientWidth * ratio);
    const height = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
  }
}

function strengthOf(mark: Mark, nowMs: number): number {
  if (prefersReducedMotion()) return 1;
  return Math.min(1, 0.3 + (0.7 * (mark.goesAtMs - nowMs)) / FADES_FOR_MS);
}

/** A mark with the function that paints it, or nothing if it is not in this picture. */
function painted<One, Paint>(one: One, paint: Paint | null): { one: One; paint: Paint }[] {
  return paint === null ? [] : [{ one, paint }];
}
