// Paints a cut and its overlay without React.
import { paintBitmap } from "../panes/bitmapCanvas";
import { setText } from "../panes/setText";
import { frameOf, type PixelGrid } from "../operator/plan/slices/place";
import type { Cut } from "./cutter";
import { PARTS, type Overlay } from "./overlay";

/** Size of labels, in page pixels. */
const LABEL_PX = 14;

/** Writes the pixels of a cut. */
export function drawPixels(canvas: HTMLCanvasElement, { grid, buffer }: Cut): void {
  const { width_px, height_px } = grid;
  paintBitmap(canvas, width_px, height_px, (context) => {
    context.putImageData(new ImageData(new Uint8ClampedArray(buffer), width_px, height_px), 0, 0);
  });
}

/** Draws the overlay over a cut of this size shown at `widthPx`; null clears it. */
export function paintOverlay(
  svg: SVGSVGElement,
  drawn: { overlay: Overlay; grid: PixelGrid; widthPx: number } | null,
): void {
  for (const part of PARTS)
    set(svg.querySelector(`[data-part=${part}]`), "d", drawn?.overlay.paths[part] ?? "");
  const labels = [...svg.querySelectorAll("text")];
  if (drawn === null) {
    for (const label of labels) setText(label, "");
    return;
  }
  const { x, y, width, height } = frameOf(drawn.grid);
  set(svg, "viewBox", `${x} ${y} ${width} ${height}`);
  const size = ((LABEL_PX * width) / drawn.widthPx).toFixed(2);
  for (const [index, label] of labels.entries()) {
    const wanted = drawn.overlay.labels[index];
    setText(label, wanted?.text ?? "");
    if (wanted === undefined) continue;
    set(label, "x", wanted.at[0].toFixed(2));
    set(label, "y", wanted.at[1].toFixed(2));
    set(label, "font-size", size);
  }
}

function set(element: Element | null, attribute: string, value: string): void {
  if (element && element.getAttribute(attribute) !== value) element.setAttribute(attribute, value);
}
