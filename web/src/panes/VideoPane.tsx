import { useEffect, useLayoutEffect, useRef, type ReactNode } from "react";
import { ConnectionNote } from "../live/ConnectionNote";
import { useLive, usePainter } from "../live/LiveContext";
import { formatNumber } from "../live/rounding";
import { VideoMarks } from "../marks/MarksLayer";
import { useTexts } from "../texts/TextsContext";
import { Announcer } from "./Announcer";
import { clearBitmap } from "./bitmapCanvas";
import { drawPicture } from "./drawPicture";
import { Moves } from "./Moves";
import { PaintRateLimiter } from "./paintRateLimiter";
import { Pane } from "./Pane";
import { setData, setText } from "./setText";
import { problemsOf } from "./problems";
import { VideoCover } from "./VideoCover";

interface VideoPaneProps {
  /** Shown beside the title. */
  tools?: ReactNode;
  /** Shown over the picture, below the cover. */
  over?: ReactNode;
}

/** The live video: a canvas painted without React, cleared and covered when it is not live. */
export function VideoPane({ tools, over }: VideoPaneProps): ReactNode {
  const texts = useTexts();
  const { live, view } = useLive();
  const canvas = useRef<HTMLCanvasElement>(null);
  const stage = useRef<HTMLDivElement>(null);
  const stamp = useRef<HTMLParagraphElement>(null);
  const painted = useRef(false);
  const limiter = useRef(new PaintRateLimiter());

  // Before the painters' first update, which detects the new canvas.
  useLayoutEffect(() => {
    live.setDraw(async (jpeg, isCurrent, onDecoded) => {
      if (canvas.current === null) return false;
      const drawn = await drawPicture(canvas.current, jpeg, isCurrent, onDecoded);
      if (drawn) painted.current = true;
      return drawn;
    });
  }, [live]);

  useEffect(() => {
    const element = canvas.current;
    if (element === null) return;
    const observer = new ResizeObserver(([entry]) => {
      if (entry === undefined) return;
      const { width, height } = entry.contentRect;
      live.load.spacePx = [width * devicePixelRatio, height * devicePixelRatio];
    });
    observer.observe(element);
    return () => {
      observer.disconnect();
      live.load.spacePx = null;
    };
  }, [live]);

  usePainter(({ nowMs, video }) => {
    setData(stage.current, "live", String(video.live));
    // Also drops a picture that was still being decoded.
    if (painted.current && !video.live && canvas.current) {
      clearBitmap(canvas.current);
      painted.current = false;
    }
    if (!limiter.current.isDue(nowMs, video.live ? `${video.imageNumber}` : "")) return;
    const age = video.live ? `${formatNumber(video.ageMs, 0)} ms` : "";
    const number = video.live ? `${texts.video.image} ${video.imageNumber}` : "";
    setText(stamp.current, video.live ? `${number} · ${texts.video.age} ${age}` : "");
  });

  const cause = view.video.live ? "old" : view.video.cause;
  return (
    <Pane
      id="video"
      title={texts.video.title}
      aside={
        <>
          <Moves />
          {tools}
          <p className="stamp" data-testid="video-stamp" ref={stamp} />
        </>
      }
    >
      <div className="video-stage" data-picture="video" data-testid="video" data-live="false" ref={stage}>
        <canvas
          className="sharp"
          ref={canvas}
          width={1280}
          height={720}
          role="img"
          aria-label={texts.video.alt}
        />
        <VideoMarks />
        <ConnectionNote />
        {over}
        <div className="when-stale" data-testid="video-cover">
          <VideoCover cause={cause} problem={problemsOf(view)[0]} />
        </div>
      </div>
      <Announcer />
    </Pane>
  );
}
