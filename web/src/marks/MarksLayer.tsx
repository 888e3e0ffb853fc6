import {
  useEffect,
  useEffectEvent,
  useRef,
  useState,
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
import { DisplayedImage } from "./displayedImage";
import type { MarkStage } from "./markStage";
import type { Size } from "./place";

/** Step of the arrow keys, as a share of the width; five times as much with shift. */
const KEY_STEP = 0.01;
const KEYS: Record<string, Point> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};

/** Marks on the video. */
export function VideoMarks(): ReactNode {
  const texts = useTexts().marks;
  const [stage] = useState(() => new DisplayedImage());
  usePainter((view) => {
    stage.update(view);
  });
  return <MarksLayer stage={stage} label={texts.layer} testId="marks" />;
}

interface MarksLayerProps {
  stage: MarkStage;
  label: string;
  testId: string;
}

/** Marks of others over a picture; inside a `MarkingProvider` also this user's input. */
export function MarksLayer({ stage, label, testId }: MarksLayerProps): ReactNode {
  const texts = useTexts().marks;
  const room = useRoom();
  const marking = useMarking();
  const canvas = useRef<HTMLCanvasElement>(null);
  const board = useRef<MarksCanvas | null>(null);
  /** Place of the pointer on the stage, which the arrow keys move. */
  const key = useRef<Point | null>(null);
  const input = useEffectEvent(() => marking?.input ?? null);
  const ageText = useEffectEvent((seconds: number) => texts.ago.replace("#", String(seconds)));

  usePainter((view) => {
    marking?.input.flush(view.nowMs);
  });

  useEffect(() => {
    const element = canvas.current;
    if (element === null) return;
    const painted = new MarksCanvas(
      element,
      stage,
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
    const stay = stage.onMove(() => {
      painted.requestPaint();
    });
    return () => {
      stay();
      leave?.();
      resized.disconnect();
      painted.stop();
    };
  }, [room, stage]);

  const placeOf = (event: PointerEvent): Point => {
    const box = canvas.current?.getBoundingClientRect();
    return [event.clientX - (box?.left ?? 0), event.clientY - (box?.top ?? 0)];
  };
  const size = (): Size => board.current?.size ?? { width: 0, height: 0 };

  const point = (place: Point): void => {
    const { surface } = stage;
    const at = surface === null ? null : stage.locate(place, size(), surface);
    if (marking === null || surface === null || at === null) return;
    key.current = place;
    marking.input.point(at, surface, performance.now());
    board.current?.requestPaint();
  };

  const move = (event: PointerEvent): void => {
    const place = placeOf(event);
    const drawnOn = marking?.input.drawnOn ?? null;
    if (drawnOn === null) {
      const isDragged = event.buttons > 0 && marking?.tool === "point";
      if (isDragged || (event.buttons === 0 && stage.isOn(place, size()))) point(place);
      return;
    }
    // A drawing stays on what it was started on, even if the picture has moved since.
    const at = stage.locate(place, size(), drawnOn);
    if (at === null) return;
    key.current = place;
    marking?.input.move(at, performance.now());
    board.current?.requestPaint();
  };

  const down = (event: PointerEvent<HTMLCanvasElement>): void => {
    const place = placeOf(event);
    const { surface } = stage;
    const isFirst = event.isPrimary && event.button === 0;
    if (marking === null || surface === null || !isFirst || !stage.isOn(place, size())) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    const at = stage.locate(place, size(), surface);
    if (at === null) return;
    if (marking.tool === "point") point(place);
    else {
      marking.input.lift();
      marking.input.down(marking.tool, at, surface, performance.now());
    }
    board.current?.requestPaint();
  };

  const up = (): void => {
    marking?.input.up(performance.now());
    board.current?.requestPaint();
  };

  const steer = (event: KeyboardEvent): void => {
    const step = KEYS[event.key];
    if (marking === null || step === undefined || stage.surface === null) return;
    event.preventDefault();
    const { width, height } = size();
    const far = KEY_STEP * width * (event.shiftKey ? 5 : 1);
    const [x, y] = key.current ?? [width / 2, height / 2];
    const place: Point = [x + far * step[0], y + far * step[1]];
    if (stage.isOn(place, size())) point(place);
  };

  const shared = { className: "marks-layer", "data-testid": testId, ref: canvas };
  if (marking === null) return <canvas {...shared} aria-hidden="true" />;
  return (
    <canvas
      {...shared}
      data-tool={marking.tool}
      role="application"
      aria-label={label}
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
