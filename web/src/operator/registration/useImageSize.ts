import { useLive } from "../../live/LiveContext";

export interface ImageSize {
  widthPx: number;
  heightPx: number;
}

/** Of the camera's own image, in which the server counts pixels, however small the picture comes. */
export function useImageSize(): ImageSize {
  const snapshot = useLive().view.newest?.snapshot;
  return { widthPx: snapshot?.width_px ?? 1280, heightPx: snapshot?.height_px ?? 720 };
}
