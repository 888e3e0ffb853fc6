// From JPEG bytes to the canvas, past React.

/** Draws the picture, and tells when it is decoded; false when it is no picture, or its line has gone meanwhile. */
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
    const context = canvas.getContext("2d", { alpha: false });
    if (context === null || !isCurrent()) return false;
    if (canvas.width !== bitmap.width || canvas.height !== bitmap.height) {
      canvas.width = bitmap.width;
      canvas.height = bitmap.height;
    }
    context.drawImage(bitmap, 0, 0);
    return true;
  } finally {
    bitmap.close();
  }
}

/** Leaves nothing of the last picture. */
export function clearPicture(canvas: HTMLCanvasElement): void {
  canvas.getContext("2d", { alpha: false })?.clearRect(0, 0, canvas.width, canvas.height);
}
