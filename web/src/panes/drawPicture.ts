// From JPEG bytes to the canvas, without React.
import { presentBitmap } from "./bitmapCanvas";

/** Draws the picture and reports when it is decoded. False if it is invalid or its connection was lost meanwhile. */
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
