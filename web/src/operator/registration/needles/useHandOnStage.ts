import { useGesture } from "@use-gesture/react";
import { useEffect, type RefObject } from "react";
import { useImageSize } from "../useImageSize";
import { translateOverlay, pinchOverlay, scaleOverlay, type Overlay, type Px } from "./overlay";
import type { OverlayController } from "./overlayController";

const WHEEL_PER_PX = 0.001;

/** Two fingers and the overlay at the start of a gesture. */
interface Pinch {
  hand: Overlay;
  from: Px;
  apart: number;
  turnDeg: number;
}

/** One finger moves the slice; two move, rotate and scale it; the wheel scales about the pointer. */
export function useHandOnStage(
  controller: OverlayController,
  stage: RefObject<HTMLDivElement | null>,
  enabled: boolean,
): void {
  const { widthPx } = useImageSize();
  const pxAt = ([x, y]: Px): Px => {
    const box = stage.current?.getBoundingClientRect();
    if (!box) return [0, 0];
    return [((x - box.left) / box.width) * widthPx, ((y - box.top) / box.width) * widthPx];
  };
  const perPx = (): number => widthPx / (stage.current?.clientWidth ?? widthPx);

  useGesture(
    {
      onDrag: ({ first, delta: [x, y], pinching, cancel }) => {
        if (pinching === true) {
          cancel();
          return;
        }
        if (first) controller.begin();
        const ratio = perPx();
        controller.change((hand) => translateOverlay(hand, [x * ratio, y * ratio]));
      },
      onPinch: ({ first, origin, da: [apart, turnDeg], memo }) => {
        let begun = memo as Pinch | undefined;
        if (first || begun === undefined) {
          const { newest } = controller;
          if (newest === null || apart === 0) return undefined;
          controller.begin();
          begun = { hand: newest.hand, from: pxAt(origin), apart, turnDeg };
        }
        const { hand, from } = begun;
        const ratio = apart / begun.apart;
        const by = turnDeg - begun.turnDeg;
        controller.change(() => pinchOverlay(hand, { from, to: pxAt(origin), ratio, turnDeg: by }));
        return begun;
      },
      onWheel: ({ event, delta: [, y], first, ctrlKey }) => {
        // With Ctrl it is reported as a pinch.
        if (ctrlKey) return;
        if (first) controller.begin();
        const about = pxAt([event.clientX, event.clientY]);
        controller.change((hand) => scaleOverlay(hand, Math.exp(-y * WHEEL_PER_PX), about));
      },
    },
    {
      target: stage,
      enabled,
      drag: { filterTaps: true, pointer: { touch: false } },
      eventOptions: { passive: false },
    },
  );

  // The page must not scroll during a gesture.
  useEffect(() => {
    const element = stage.current;
    if (element === null) return;
    element.style.setProperty("touch-action", enabled ? "none" : "manipulation");
    const keep = (event: WheelEvent): void => {
      if (enabled) event.preventDefault();
    };
    element.addEventListener("wheel", keep, { passive: false });
    return () => {
      element.removeEventListener("wheel", keep);
    };
  }, [stage, enabled]);
}
