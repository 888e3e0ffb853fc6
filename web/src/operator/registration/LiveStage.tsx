import { Button } from "@mantine/core";
import { useEffect, useLayoutEffect, useRef, useState, type ReactNode, type RefObject } from "react";
import { useLive, usePainter } from "../../live/LiveContext";
import { formatNumber } from "../../live/rounding";
import { Announcer } from "../../panes/Announcer";
import { clearBitmap } from "../../panes/bitmapCanvas";
import { drawPicture } from "../../panes/drawPicture";
import { setData, setText } from "../../panes/setText";
import { VideoCover } from "../../panes/VideoCover";
import { useTexts } from "../../texts/TextsContext";
import { formatClock } from "../parts/format";
import { interpolate } from "../../texts/interpolate";
import { useImageSize } from "./useImageSize";

interface LiveStageProps {
  /** Overlay in pixels of the camera's image. */
  children?: ReactNode;
  stage?: RefObject<HTMLDivElement | null>;
  /** Canvas of the live picture. */
  picture?: RefObject<HTMLCanvasElement | null>;
  isFrozen?: boolean;
  onFreeze?: (isFrozen: boolean) => void;
}

/** The live video with an overlay; it can be frozen and is then marked as such. */
export function LiveStage({
  children,
  stage,
  picture,
  isFrozen = false,
  onFreeze,
}: LiveStageProps): ReactNode {
  const texts = useTexts();
  const { live, view } = useLive();
  const size = useImageSize();
  const ownStage = useRef<HTMLDivElement>(null);
  const ownCanvas = useRef<HTMLCanvasElement>(null);
  const still = useRef<HTMLCanvasElement>(null);
  const stamp = useRef<HTMLParagraphElement>(null);
  const frozenAt = useRef(0);
  const [frozenClock, setFrozenClock] = useState("");
  const box = stage ?? ownStage;
  const canvas = picture ?? ownCanvas;

  // Before the painters' first update, which detects the new canvas.
  useLayoutEffect(() => {
    live.setDraw((jpeg, isCurrent, onDecoded) =>
      canvas.current === null
        ? Promise.resolve(false)
        : drawPicture(canvas.current, jpeg, isCurrent, onDecoded),
    );
  }, [live, canvas]);

  useEffect(() => {
    const element = box.current;
    if (element === null) return;
    const watch = new ResizeObserver(() => {
      element.style.setProperty("--fit", String(element.clientWidth / size.widthPx));
    });
    watch.observe(element);
    return () => {
      watch.disconnect();
    };
  }, [box, size.widthPx]);

  usePainter(({ video, nowMs }) => {
    setData(box.current, "live", String(video.live || isFrozen));
    if (isFrozen) {
      setText(
        stamp.current,
        interpolate(texts.registration.frozen.stamp, {
          clock: frozenClock,
          age: formatNumber((nowMs - frozenAt.current) / 1000, 0),
        }),
      );
      return;
    }
    setText(
      stamp.current,
      video.live
        ? `${texts.video.image} ${video.imageNumber} · ${texts.video.age} ${formatNumber(video.ageMs, 0)} ms`
        : "",
    );
    if (!video.live && canvas.current) clearBitmap(canvas.current);
  });

  const toggle = (): void => {
    if (canvas.current === null || still.current === null || onFreeze === undefined) return;
    if (!isFrozen) {
      still.current.width = canvas.current.width;
      still.current.height = canvas.current.height;
      still.current.getContext("2d", { alpha: false })?.drawImage(canvas.current, 0, 0);
      frozenAt.current = performance.now();
      setFrozenClock(formatClock(new Date().toISOString(), texts.language));
    }
    onFreeze(!isFrozen);
  };

  const cause = view.video.live ? "old" : view.video.cause;
  return (
    <div className="live-stage" data-frozen={isFrozen}>
      <div className="live-stage-head">
        <p className="stamp" ref={stamp} data-testid="stage-stamp" />
        {onFreeze !== undefined && (
          <Button
            size="md"
            variant={isFrozen ? "filled" : "default"}
            color="yellow"
            aria-pressed={isFrozen}
            onClick={toggle}
          >
            {isFrozen ? texts.registration.frozen.release : texts.registration.frozen.freeze}
          </Button>
        )}
      </div>
      <div
        className="video-stage"
        data-live="false"
        data-testid="stage"
        ref={box}
        style={{ aspectRatio: `${size.widthPx} / ${size.heightPx}` }}
      >
        <canvas ref={canvas} width={1280} height={720} role="img" aria-label={texts.registration.videoAlt} />
        <canvas
          className="still"
          ref={still}
          width={1280}
          height={720}
          hidden={!isFrozen}
          aria-hidden="true"
        />
        <div className="stage-space" style={{ width: size.widthPx, height: size.heightPx }}>
          {children}
        </div>
        <div className="when-stale">
          <VideoCover cause={cause} />
        </div>
      </div>
      <Announcer />
    </div>
  );
}
