import { useEffect, useRef, useState, type ReactNode } from "react";
import type { DrawingBudget } from "../live/budget";
import { usePainter, useLive } from "../live/LiveContext";
import { useBoneMarks } from "../marks/useBoneMarks";
import { formatDuration, formatNumber } from "../live/rounding";
import { useTexts } from "../texts/TextsContext";
import { Cover } from "./Cover";
import { Pane } from "./Pane";
import { PaintRateLimiter } from "./paintRateLimiter";
import { setSize, sendRate, sendView, type ViewName } from "./sceneFrame";
import { SceneViewButtons } from "./SceneViewButtons";
import { setData, setText } from "./setText";
import { hasWebGl } from "./webgl";

/** A scene that sends nothing for this long, although the server answers, is reloaded. */
const RELOAD_AFTER_MS = 15_000;

/** After this many loads without an image the scene counts as missing instead of loading. */
const TRIES_WITHOUT_AN_IMAGE = 2;

/** The 3-D scene in its frame, covered whenever its image is not live. */
export function ScenePane({ tabs }: { tabs?: ReactNode }): ReactNode {
  const texts = useTexts();
  const { live, view } = useLive();
  const stage = useRef<HTMLDivElement>(null);
  const stamp = useRef<HTMLParagraphElement>(null);
  const age = useRef<HTMLSpanElement>(null);
  const frame = useRef<HTMLIFrameElement>(null);
  const limiter = useRef(new PaintRateLimiter());
  const isMarking = useBoneMarks(frame);
  const sentView = useRef<DrawingBudget | null>(null);
  const [attempt, setAttempt] = useState(0);
  const [chosen, setChosen] = useState<ViewName>("behind");
  // The frame is not loaded before the server has answered; it would show an error page.
  const known = view.newest !== null;
  const [wanted, setWanted] = useState(known);
  if (known && !wanted) setWanted(true);

  useEffect(() => live.load.showScene(), [live]);

  usePainter(({ nowMs, scene, budget }) => {
    if (budget !== sentView.current) {
      sentView.current = budget;
      sendRate(frame.current, budget);
      setSize(frame.current, budget);
    }
    setData(stage.current, "live", String(scene.state === "live"));
    if (!limiter.current.isDue(nowMs, scene.state === "live" ? `${scene.imageNumber}` : scene.state)) return;
    const behind = scene.state === "live" && scene.behindImages > 0 ? ` (−${scene.behindImages})` : "";
    setText(
      stamp.current,
      scene.state === "live"
        ? `${texts.video.image} ${scene.imageNumber}${behind} · ${texts.video.age} ${formatNumber(scene.ageMs, 0)} ms`
        : "",
    );
    setText(age.current, scene.state === "stale" && scene.ageMs !== null ? formatDuration(scene.ageMs) : "");
  });

  const lives = view.scene.state === "live";
  const isOff = view.scene.state === "off";
  const reachable = view.link === "open";
  useEffect(() => {
    if (lives || isOff || !wanted || !reachable) return;
    const timer = setTimeout(() => {
      setAttempt((count) => count + 1);
    }, RELOAD_AFTER_MS);
    return () => {
      clearTimeout(timer);
    };
  }, [lives, isOff, wanted, reachable, attempt]);

  const loading = view.scene.state === "loading" && attempt < TRIES_WITHOUT_AN_IMAGE;
  const hindrance = !hasWebGl() ? "unsupported" : isOff ? "off" : loading ? "loading" : "stale";
  const isCalm = hindrance === "off" || hindrance === "loading";
  return (
    <Pane
      id="scene"
      title={texts.scene.title}
      aside={
        <>
          <p className="stamp" data-testid="scene-stamp" ref={stamp} />
          {tabs}
        </>
      }
    >
      <div className="scene-stage" data-picture="scene" data-testid="scene" data-live="false" ref={stage}>
        {wanted && !isOff && hasWebGl() && (
          <iframe
            key={attempt}
            ref={(element) => {
              frame.current = element;
              setSize(element, live.load.budget);
            }}
            src="/scene/"
            data-marking={isMarking}
            title={texts.scene.title}
            onLoad={() => {
              sendView(frame.current, chosen);
              sendRate(frame.current, live.load.budget);
            }}
          />
        )}
        <SceneViewButtons
          chosen={chosen}
          onView={(name) => {
            setChosen(name);
            sendView(frame.current, name);
          }}
        />
        <div className="when-stale" data-testid="scene-cover">
          <Cover
            urgency={isCalm ? "none" : "medium"}
            title={texts.scene[hindrance]}
            sentence={texts.scene[`${hindrance}Hint`]}
          >
            <span className="since" ref={age} />
            {isOff && (
              <button
                type="button"
                className="cover-button"
                data-testid="show-scene"
                onClick={() => {
                  live.switchSceneOn();
                }}
              >
                {texts.scene.show}
              </button>
            )}
          </Cover>
        </div>
      </div>
    </Pane>
  );
}
