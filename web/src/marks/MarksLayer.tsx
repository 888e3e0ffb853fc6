import {
  useEffect,
  useEffectEvent,
  useRef,
  type KeyboardEvent,
  type PointerEvent,
  type ReactNode,
} from "react";
import { usePainter } from "../live/LiveContext";
import type { Point } from "../room/messages";
import { useRoom } from "../room/RoomContext";
import { NOBODY } from "../room/roomState";
import { useTexts } from "../texts/TextsContext";
import { MarksCanvas } from "./marksCanvas";
import { useMarking } from "./MarkingContext";
import { isOnImage, onImage } from "./place";
import { DisplayedImage } from "./displayedImage";

/** Step of the arrow keys, as a share of the picture width; five times as much with shift. */
const KEY_STEP = 0.01;
const KEYS: Record<string, Point> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};

/** Marks of others over the picture; inside a `MarkingProvider` also this user's input. */
export function MarksLayer(): ReactNode {
  const texts = useTexts().marks;
  const room = useRoom();
  const marking = useMarking();
  const canvas = useRef<HTMLCanvasElement>(null);
  const board = useRef<MarksCanvas | null>(null);
  const displayed = useRef(new DisplayedImage());
  const key = useRef<Point | null>(null);
  const input = useEffectEvent(() => marking?.input ?? null);
  const ageText = useEffectEvent((seconds: number) => texts.ago.replace("#", String(seconds)));

  usePainter((view) => {
    displayed.current.update(view);
    marking?.input.flush(view.nowMs);
  });

  useEffect(() => {
    const element = canvas.current;
    if (element === null) return;
    const painted = new MarksCanvas(
      element,
      displayed.current,
      () => room?.now() ?? NOBODY,
      () => input(),
      (seconds) => ageText(seconds),
    );
    board.current = painted;
    const leave = room?.onMarks(() => {
      painted.requestPaint();
    });
    const resized = new ResizeObserver(() => {
      painted.requestPaint();
    });
    resized.observe(element);
    return () => {
      leave?.();
      resized.disconnect();
      painted.stop();
    };
  }, [room]);

  const placeOf = (event: PointerEvent): Point | null => {
    const placement = board.current?.placement ?? null;
    const box = canvas.current?.getBoundingClientRect();
    if (placement === null || box === undefined) return null;
    const at: Point = [event.clientX - box.left, event.clientY - box.top];
    const drawing = event.buttons > 0;
    return drawing || isOnImage(at, placement) ? onImage(at, placement) : null;
  };

  const move = (event: PointerEvent): void => {
    const at = placeOf(event);
    const { moment } = displayed.current;
    if (marking === null || at === null || moment === null) return;
    key.current = at;
    const { tool } = marking;
    if (tool !== "point" && event.buttons > 0) marking.input.move(at, performance.now());
    else marking.input.point(at, moment, performance.now());
    board.current?.requestPaint();
  };

  const down = (event: PointerEvent<HTMLCanvasElement>): void => {
    const at = placeOf(event);
    const { moment } = displayed.current;
    if (marking === null || at === null || moment === null || !event.isPrimary || event.button !== 0) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    if (marking.tool === "point") marking.input.point(at, moment, performance.now());
    else {
      marking.input.lift();
      marking.input.down(marking.tool, at, moment, performance.now());
    }
    board.current?.requestPaint();
  };

  const up = (): void => {
    marking?.input.up(performance.now());
    board.current?.requestPaint();
  };

  const steer = (event: KeyboardEvent): void => {
    const step = KEYS[event.key];
    const { moment, size } = displayed.current;
    if (marking === null || step === undefined || moment === null) return;
    event.preventDefault();
    const far = KEY_STEP * size.width * (event.shiftKey ? 5 : 1);
    const [x, y] = key.current ?? [size.width / 2, size.height / 2];
    const at: Point = [clamped(x + far * step[0], size.width), clamped(y + far * step[1], size.height)];
    key.current = at;
    marking.input.point(at, moment, performance.now());
    board.current?.requestPaint();
  };

  const shared = { className: "marks-layer", "data-testid": "marks", ref: canvas };
  if (marking === null) return <canvas {...shared} aria-hidden="true" />;
  return (
    <canvas
      {...shared}
      data-tool={marking.tool}
      role="application"
      aria-label={texts.layer}
      tabIndex={0}
      onPointerMove={move}
      onPointerDown={down}
      onPointerUp={up}
      onPointerCancel={up}
      onPointerLeave={({ pointerType }) => {
        // A finger leaves after every tap: its pointer stays until it expires.
        if (pointerType !== "touch") marking.input.lift();
        board.current?.requestPaint();
      }}
      onKeyDown={steer}
    />
  );
}

function clamped(value: number, size: number): number {
  return Math.min(Math.max(Math.round(value), 0), size - 1);
}
