import { useEffect, useRef, type ReactNode } from "react";
import { useTexts } from "../../../texts/TextsContext";
import { cssMatrix, multiply } from "./overlay";
import type { OverlayDrawing, OverlayController } from "./overlayController";

interface SliceLayerProps {
  controller: OverlayController;
  slice: NonNullable<OverlayDrawing["slice"]>;
  vertebra: string;
}

/** Reference slice, translucent over the live picture, placed by the server. */
export function SliceLayer({ controller, slice, vertebra }: SliceLayerProps): ReactNode {
  const texts = useTexts().registration.needles;
  const image = useRef<HTMLImageElement>(null);
  useEffect(
    () =>
      controller.onPaint(() => {
        const { newest, sinceAnswer } = controller;
        const place = newest?.laid.slice;
        if (image.current === null || newest === null || sinceAnswer === null || !place) return;
        image.current.style.transform = cssMatrix(multiply(sinceAnswer, place.image_from_slice.flat()));
        image.current.style.opacity = String(newest.hand.fade_ratio);
      }),
    [controller],
  );
  return (
    <img
      ref={image}
      className="slice-layer"
      data-testid="slice-layer"
      src={`/api/plan/vertebrae/${encodeURIComponent(vertebra)}/reference.png`}
      alt={texts.sliceAlt}
      draggable={false}
      style={{ width: slice.width_px, height: slice.height_px }}
    />
  );
}
