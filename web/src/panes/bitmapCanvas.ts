// A canvas that shows finished bitmaps. Without a graphics card the browser copies other canvases whenever any part
// of the page changes, but this one only for a new bitmap.

let sketch: OffscreenCanvas | undefined;

/** Shows the bitmap and consumes it. */
export function presentBitmap(canvas: HTMLCanvasElement, bitmap: ImageBitmap): void {
  if (canvas.width !== bitmap.width || canvas.height !== bitmap.height) {
    canvas.width = bitmap.width;
    canvas.height = bitmap.height;
  }
  canvas.getContext("bitmaprenderer")?.transferFromImageBitmap(bitmap);
}

/** Draws into a bitmap of this size and shows it. */
export function paintBitmap(
  canvas: HTMLCanvasElement,
  width: number,
  height: number,
  draw: (context: OffscreenCanvasRenderingContext2D) => void,
): void {
  sketch ??= new OffscreenCanvas(width, height);
  sketch.width = width;
  sketch.height = height;
  const context = sketch.getContext("2d");
  if (context === null) return;
  draw(context);
  presentBitmap(canvas, sketch.transferToImageBitmap());
}

/** Clears the canvas. */
export function clearBitmap(canvas: HTMLCanvasElement): void {
  canvas.getContext("bitmaprenderer")?.transferFromImageBitmap(null);
}
