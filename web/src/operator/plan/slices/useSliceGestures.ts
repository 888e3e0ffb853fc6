// Gestures: one finger scrolls, changes the window or moves the picture, two pinch. Taps tolerate gloves.
import { useGesture } from "@use-gesture/react";
import { useRef, type RefObject } from "react";
import type { Greys } from "./address";
import type { Vec2 } from "./place";
import type { Hand } from "./SlicesContext";
import { moved, zoomedAt, type Stage, type Zoom } from "./zoom";

/** Finger travel per slice. */
const PX_A_SLICE = 9;
const WHEEL_PX_A_SLICE = 60;
const HU_A_PX = 4;
const TAP_WITHIN_PX = 10;

interface Gestures {
  stage: RefObject<HTMLDivElement | null>;
  size: Stage;
  frame: { x: number; y: number; width: number; height: number } | null;
  zoom: Zoom | null;
  hand: Hand;
  greys: Greys;
  onTap: (at: Vec2) => void;
  onScroll: (steps: number) => void;
  onZoom: (zoom: Zoom) => void;
  onGreys: (greys: Greys) => void;
}

export function useSliceGestures(of: Gestures): void {
  const { stage, size, frame, zoom, hand, greys } = of;
  const wheel = useRef(0);
  const on = (x: number, y: number): Vec2 => {
    const box = stage.current?.getBoundingClientRect();
    return [x - (box?.left ?? 0), y - (box?.top ?? 0)];
  };
  useGesture(
    {
      onDrag: ({ tap, xy, delta, movement, first, pinching, memo, event }) => {
        if (pinching === true || isHandle(event)) return undefined;
        if (tap) of.onTap(on(...xy));
        else if (hand === "greys") of.onGreys(changed(greys, delta));
        else if (hand === "move" && zoom !== null && frame !== null) of.onZoom(moved(zoom, frame, delta));
        else if (hand === "scroll" || hand === "measure") {
          const before = first ? 0 : ((memo as number | undefined) ?? 0);
          const now = Math.trunc(movement[1] / PX_A_SLICE);
          if (now !== before) of.onScroll(now - before);
          return now;
        }
        return undefined;
      },
      onPinch: ({ origin, da: [distance], first, memo, event }) => {
        // The wheel with Ctrl is handled below.
        if (event.type === "wheel") return null;
        const at = on(...origin);
        const last = first ? null : (memo as { distance: number; at: Vec2 } | null);
        if (last !== null && zoom !== null && frame !== null && last.distance > 0) {
          const shifted = moved(zoom, frame, [at[0] - last.at[0], at[1] - last.at[1]]);
          of.onZoom(zoomedAt(shifted, size, frame, at, distance / last.distance));
        }
        return { distance, at };
      },
      onWheel: ({ delta: [, dy], event, ctrlKey, first }) => {
        if (ctrlKey) {
          event.preventDefault();
          if (zoom === null || frame === null) return;
          of.onZoom(zoomedAt(zoom, size, frame, on(event.clientX, event.clientY), Math.exp(-dy / 300)));
          return;
        }
        event.preventDefault();
        wheel.current = (first ? 0 : wheel.current) + dy;
        const steps = Math.trunc(wheel.current / WHEEL_PX_A_SLICE);
        wheel.current -= steps * WHEEL_PX_A_SLICE;
        if (steps !== 0) of.onScroll(steps);
      },
    },
    {
      target: stage,
      eventOptions: { passive: false },
      drag: { filterTaps: true, tapsThreshold: TAP_WITHIN_PX, pointer: { keys: false } },
    },
  );
}

function isHandle(event: { target: EventTarget | null }): boolean {
  return event.target instanceof Element && event.target.closest("[data-handle]") !== null;
}

function changed(greys: Greys, [dx, dy]: Vec2): Greys {
  return {
    window_hu: Math.min(6000, Math.max(50, Math.round(greys.window_hu + dx * HU_A_PX))),
    level_hu: Math.min(3000, Math.max(-1000, Math.round(greys.level_hu + dy * HU_A_PX))),
  };
}
