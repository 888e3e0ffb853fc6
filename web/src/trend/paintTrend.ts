// Paints the curve of a figure on its canvas, without React.
import type { Status } from "../live/messages";
import { formatFigure } from "../live/rounding";
import { paintBitmap } from "../panes/bitmapCanvas";
import { curveOf, type CurveName } from "./curve";
import { SPAN_MS, type Sample } from "./history";

/** Colours of the theme by the server's status. */
const INK: Record<Status, string> = {
  within: "--ink",
  over: "--medium",
  through: "--high",
  unlimited: "--ink-soft",
  outside: "--ink-soft",
};
const LINE_PX = 2;
const LIMIT_PX = 1.5;
const DASH_PX = [5, 4];
/** A smaller canvas is not laid out yet. */
const MIN_SIDE_PX = 12;
const MIN_LABELLED_PX = 120;
const LABEL_PX = 13;

interface TrendFrame {
  /** Space at the right edge. */
  nowMs: number;
  spanMs?: number;
  maxStepMs?: number;
  /** Labelled with the values at its edges. */
  hasRange?: boolean;
}

export function paintTrend(
  canvas: HTMLCanvasElement,
  name: CurveName,
  samples: readonly Sample[],
  { nowMs, spanMs = SPAN_MS, maxStepMs, hasRange = false }: TrendFrame,
): void {
  const { clientWidth, clientHeight } = canvas;
  if (clientWidth < MIN_SIDE_PX || clientHeight < MIN_SIDE_PX) return;
  const ratio = devicePixelRatio;
  const style = getComputedStyle(canvas);
  const inkOf = (variable: string): string => style.getPropertyValue(variable);
  const inset = LINE_PX;
  const curve = curveOf(samples, name, {
    nowMs,
    spanMs,
    ...(maxStepMs === undefined ? {} : { maxStepMs }),
    width: clientWidth - 2 * inset,
    height: clientHeight - 2 * inset,
  });
  paintBitmap(canvas, Math.round(clientWidth * ratio), Math.round(clientHeight * ratio), (context) => {
    context.setTransform(ratio, 0, 0, ratio, inset * ratio, inset * ratio);
    context.lineJoin = "round";
    context.lineWidth = 1;
    const draw = (points: readonly (readonly [number, number])[], ink: string): void => {
      context.strokeStyle = ink;
      context.beginPath();
      for (const [index, [x, y]] of points.entries()) {
        if (index === 0) context.moveTo(x, y);
        else context.lineTo(x, y);
      }
      // A single sample between gaps is a dot.
      if (points.length === 1 && points[0] !== undefined)
        context.lineTo(points[0][0] + LINE_PX, points[0][1]);
      context.stroke();
    };
    if (curve.wallY !== null) {
      draw(
        [
          [0, curve.wallY],
          [clientWidth - 2 * inset, curve.wallY],
        ],
        inkOf("--high"),
      );
    }
    context.lineWidth = LIMIT_PX;
    context.setLineDash(DASH_PX);
    for (const limit of curve.limit) draw(limit, inkOf("--low"));
    context.setLineDash([]);
    context.lineWidth = LINE_PX;
    for (const { status, points } of curve.strokes) draw(points, inkOf(INK[status]));
    if (clientWidth < MIN_LABELLED_PX) return;
    context.font = `${LABEL_PX}px ${style.fontFamily}`;
    context.fillStyle = inkOf("--ink-soft");
    if (!hasRange) {
      context.fillText(`\u2212${spanMs / 1000} s`, 0, LABEL_PX);
      return;
    }
    const decimals = name === "risk" ? 0 : 1;
    context.fillText(formatFigure(curve.range[1], decimals), 0, LABEL_PX);
    context.fillText(formatFigure(curve.range[0], decimals), 0, clientHeight - 2 * inset - 3);
  });
}
