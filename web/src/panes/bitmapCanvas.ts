// A canvas that shows finished bitmaps. Without a graphics card the browser copies every other canvas whenever any part of
// the page changes; this one only when it has a new bitmap.

let sketch: OffscreenCanvas | undefined;

/** Shows the bitmap, which is used up by it. */
export function presentBitmap(canvas: HTMLCanvasElement, bitmap: ImageBitmap): void {
  if (canvas.width !== bitmap.width || canvas.height !== bitmap.height) {
    canvas.width = bitmap.width;
    canvas.height = bitmap.height;
  }
  canvas.getContext("bitmaprenderer")?.transferFromImageBitmap(bitmap);
}

/** Draws in a bitmap of this size, and shows it. */
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

/** Leaves nothing of the last bitmap. */
export function clearBitmap(canvas: HTMLCanvasElement): void {
  canvas.getContext("bitmaprenderer")?.transferFromImageBitmap(null);
}
