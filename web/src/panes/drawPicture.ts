// From JPEG bytes to the canvas, past React.
import { presentBitmap } from "./bitmapCanvas";

/** Draws the picture, and reports when it is decoded; false when it is no picture, or its line has gone meanwhile. */
export async function drawPicture(
  canvas: HTMLCanvasElement,
  jpeg: Uint8Array<ArrayBuffer>,
  isCurrent: () => boolean,
  onDecoded: () => void,
): Promise<boolean> {
  let bitmap: ImageBitmap;
  try {
    bitmap = await createImageBitmap(new Blob([jpeg], { type: "image/jpeg" }));
  } catch {
    return false;
  }
  onDecoded();
  try {
    if (!isCurrent()) return false;
    presentBitmap(canvas, bitmap);
    return true;
  } finally {
    bitmap.close();
  }
}
