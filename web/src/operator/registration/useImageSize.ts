import { useLive } from "../../live/LiveContext";

interface ImageSize {
  widthPx: number;
  heightPx: number;
}

/** Size of the camera's image, which the server's pixel coordinates refer to, whatever the picture size. */
export function useImageSize(): ImageSize {
  const snapshot = useLive().view.newest?.snapshot;
  return { widthPx: snapshot?.width_px ?? 1280, heightPx: snapshot?.height_px ?? 720 };
}
