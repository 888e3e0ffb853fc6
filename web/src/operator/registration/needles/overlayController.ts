// Controls the overlay: painted at once, requested from the server as fast as it answers, exact with each answer.
import { Rejection } from "../../../rest/client";
import type { LaidMessage } from "../../../api";
import { isSameOverlay, similarity, type Matrix, type Overlay } from "./overlay";

export type OverlayDrawing = LaidMessage;

export interface OverlayState {
  hand: Overlay | null;
  laid: OverlayDrawing | null;
  rejection: Rejection | null;
  /** Whether the drawing is exact. */
  settled: boolean;
  canUndo: boolean;
}

const MAX_UNDO = 50;

export class OverlayController {
  private hand: Overlay | null = null;
  private laid: OverlayDrawing | null = null;
  private rejection: Rejection | null = null;
  private before: Overlay[] = [];
  private isRequesting = false;
  private stopped = false;
  private readonly painters = new Set<() => void>();
  private readonly readers = new Set<() => void>();
  private published: OverlayState = {
    hand: null,
    laid: null,
    rejection: null,
    settled: false,
    canUndo: false,
  };

  constructor(private readonly fetchOverlay: (overlay: Overlay | null) => Promise<OverlayDrawing>) {}

  /** Called when the overlay must be repainted, without React. */
  onPaint(paint: () => void): () => void {
    this.painters.add(paint);
    paint();
    return () => this.painters.delete(paint);
  }

  readonly subscribe = (reader: () => void): (() => void) => {
    this.readers.add(reader);
    return () => this.readers.delete(reader);
  };

  readonly state = (): OverlayState => this.published;

  /** Position from the ruler. */
  start(): void {
    this.stopped = false;
    if (this.laid === null) void this.requestNow(true);
  }

  stop(): void {
    this.stopped = true;
  }

  /** Remembers the position before a gesture. */
  begin(): void {
    if (this.hand === null) return;
    this.before = [...this.before.slice(-MAX_UNDO), this.hand];
  }

  change(next: (hand: Overlay) => Overlay): void {
    if (this.hand === null) return;
    this.hand = next(this.hand);
    this.paint();
    void this.requestNow(false);
  }

  /** A single step as a complete gesture. */
  step(next: (hand: Overlay) => Overlay): void {
    this.begin();
    this.change(next);
  }

  undo(): void {
    const last = this.before.pop();
    if (last === undefined) return;
    this.change(() => last);
  }

  /** Resets to the ruler's position; can be undone. */
  reset(): void {
    this.begin();
    void this.requestNow(true);
  }

  /** Transforms the server's last drawing to the present position. */
  get sinceAnswer(): Matrix | null {
    return this.laid === null || this.hand === null ? null : similarity(this.laid.overlay, this.hand);
  }

  get newest(): { hand: Overlay; laid: OverlayDrawing } | null {
    return this.laid === null || this.hand === null ? null : { hand: this.hand, laid: this.laid };
  }

  private async requestNow(fresh: boolean): Promise<void> {
    if (this.isRequesting && !fresh) return;
    this.isRequesting = true;
    this.publish();
    try {
      const requested = fresh ? null : this.hand;
      const laid = await this.fetchOverlay(requested);
      this.laid = laid;
      this.rejection = null;
      // Changes made in the meantime are applied next.
      if (requested === null) this.hand = laid.overlay;
    } catch (error) {
      if (!(error instanceof Rejection)) throw error;
      this.rejection = error;
    } finally {
      this.isRequesting = false;
    }
    this.paint();
    this.publish();
    const behind = this.laid !== null && this.hand !== null && !isSameOverlay(this.laid.overlay, this.hand);
    if (behind && this.rejection === null && !this.stopped) void this.requestNow(false);
  }

  private paint(): void {
    for (const paint of this.painters) paint();
  }

  private publish(): void {
    const { hand, laid, rejection } = this;
    const settled = hand !== null && laid !== null && rejection === null && isSameOverlay(laid.overlay, hand);
    this.published = { hand, laid, rejection, settled, canUndo: this.before.length > 0 };
    for (const reader of this.readers) reader();
  }
}
