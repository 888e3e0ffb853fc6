import { useRef, type ReactNode, type RefObject } from "react";
import { usePainter } from "../../../live/LiveContext";
import { useImageSize } from "../useImageSize";

const SIDE_PX = 168;
const TIMES = 5;

interface MagnifierProps {
  picture: RefObject<HTMLCanvasElement | null>;
  /** In pixels of the camera's image; null shows nothing. */
  at: readonly number[] | null;
  name: string;
}

/** The live picture around a mark, magnified five times, centred on the mark. */
export function Magnifier({ picture, at, name }: MagnifierProps): ReactNode {
  const lens = useRef<HTMLCanvasElement>(null);
  const { widthPx } = useImageSize();
  usePainter(({ video }) => {
    const context = lens.current?.getContext("2d", { alpha: false });
    if (!context) return;
    context.fillRect(0, 0, SIDE_PX, SIDE_PX);
    const from = picture.current;
    if (at === null || from === null || !video.live) return;
    // The picture may be smaller than the camera's image.
    const ratio = from.width / widthPx;
    const shown = (SIDE_PX / TIMES) * ratio;
    const [x = 0, y = 0] = at;
    context.imageSmoothingEnabled = false;
    context.drawImage(
      from,
      (x + 0.5) * ratio - shown / 2,
      (y + 0.5) * ratio - shown / 2,
      shown,
      shown,
      0,
      0,
      SIDE_PX,
      SIDE_PX,
    );
    context.strokeStyle = "#ffd84d";
    context.lineWidth = 2;
    context.beginPath();
    for (const [fromX, fromY, toX, toY] of [
      [0, 0.5, 0.42, 0.5],
      [0.58, 0.5, 1, 0.5],
      [0.5, 0, 0.5, 0.42],
      [0.5, 0.58, 0.5, 1],
    ] as const) {
      context.moveTo(SIDE_PX * fromX, SIDE_PX * fromY);
      context.lineTo(SIDE_PX * toX, SIDE_PX * toY);
    }
    context.stroke();
  });
  return (
    <canvas className="magnifier" ref={lens} width={SIDE_PX} height={SIDE_PX} role="img" aria-label={name} />
  );
}
