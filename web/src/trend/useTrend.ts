import { useEffect, useRef, type RefObject } from "react";
import { usePainter } from "../live/LiveContext";
import { clearBitmap } from "../panes/bitmapCanvas";
import { FIGURES } from "../panes/limits";
import { setData } from "../panes/setText";
import { isTrendShown, TrendHistory } from "./history";
import { paintTrend } from "./paintTrend";

const EVERY_MS = 250;

/** Paints the curves of this pane, at most four times a second; cleared as soon as figures are too old. */
export function useTrend(pane: RefObject<HTMLElement | null>): void {
  const history = useRef(new TrendHistory());
  const paintedAtMs = useRef(-Infinity);
  const timer = useRef<ReturnType<typeof setTimeout>>(undefined);
  useEffect(() => {
    return () => {
      clearTimeout(timer.current);
    };
  }, []);

  const canvases = (): { name: (typeof FIGURES)[number]; canvas: HTMLCanvasElement }[] =>
    FIGURES.flatMap((name) => {
      const canvas = pane.current?.querySelector<HTMLCanvasElement>(`canvas[data-trend=${name}]`);
      return canvas ? [{ name, canvas }] : [];
    });

  usePainter(({ nowMs, numbers }) => {
    history.current.add(nowMs, numbers);
    const isShown = isTrendShown(numbers);
    const wasShown = pane.current?.dataset["trend"] === "true";
    setData(pane.current, "trend", String(isShown));
    if (!isShown) {
      clearTimeout(timer.current);
      if (wasShown) for (const { canvas } of canvases()) clearBitmap(canvas);
      return;
    }
    if (nowMs - paintedAtMs.current < EVERY_MS) return;
    paintedAtMs.current = nowMs;
    // Runs after the figures of this image were painted.
    timer.current = setTimeout(() => {
      for (const { name, canvas } of canvases()) paintTrend(canvas, name, history.current.samples, { nowMs });
    });
  });
}
