import { useGesture } from "@use-gesture/react";
import { useEffect, useRef, type RefObject } from "react";
import { useImageSize } from "../useImageSize";
import { endNear, type End, type Mark } from "./marks";
import type { Px } from "./overlay";

/** Distance within which a touch grabs a mark, on the screen. */
const GRIP_CSS_PX = 36;

interface Hands {
  onPlace: (at: Px) => void;
  onTake: (end: End) => void;
  onMove: (end: End, at: Px) => void;
}

/** A touch sets a mark, or grabs one nearby and drags it. */
export function useMarkOnStage(
  stage: RefObject<HTMLDivElement | null>,
  marks: readonly Mark[],
  { onPlace, onTake, onMove }: Hands,
): void {
  const { widthPx } = useImageSize();
  const grip = useRef<{ end: End; off: Px } | null>(null);
  const pxAt = ([x, y]: Px): Px => {
    const box = stage.current?.getBoundingClientRect();
    if (!box) return [0, 0];
    return [((x - box.left) / box.width) * widthPx - 0.5, ((y - box.top) / box.width) * widthPx - 0.5];
  };

  useGesture(
    {
      onDrag: ({ first, last, tap, xy, initial }) => {
        if (first) {
          const from = pxAt(initial);
          const within = (GRIP_CSS_PX * widthPx) / (stage.current?.clientWidth ?? widthPx);
          const end = endNear(marks, from, within);
          const at = end === null ? null : (marks[end.needle]?.[end.end] ?? null);
          grip.current =
            end === null || at === null ? null : { end, off: [at[0] - from[0], at[1] - from[1]] };
          if (end !== null) onTake(end);
        }
        const now = pxAt(xy);
        if (grip.current !== null) {
          // Relative movement, so that a mark does not jump under the finger.
          const { end, off } = grip.current;
          if (!tap) onMove(end, [now[0] + off[0], now[1] + off[1]]);
        } else if (last && tap) onPlace(now);
      },
    },
    { target: stage, drag: { filterTaps: true, tapsThreshold: 8 } },
  );

  useEffect(() => {
    stage.current?.style.setProperty("touch-action", "none");
  }, [stage]);
}
