import { Button } from "@mantine/core";
import { useEffect, useRef, useState, type ReactNode } from "react";
import { putRecordingsByNameScenesByKey } from "../../api";
import { isSceneNote } from "../../live/sceneAge";
import { Cover } from "../../panes/Cover";
import { sendView, type ViewName } from "../../panes/sceneFrame";
import { SceneViewButtons } from "../../panes/SceneViewButtons";
import { hasWebGl } from "../../panes/webgl";
import { Rejection } from "../../rest/client";
import { RejectionNote } from "../../rest/RejectionNote";
import { useTexts } from "../../texts/TextsContext";
import type { RecordedInstant } from "./useShownInstant";

interface InstantSceneProps {
  /** Name of the recording. */
  name: string;
  instant: RecordedInstant | null;
}

/** The 3-D scene of the displayed instant, loaded when it is first requested. */
export function InstantScene({ name, instant }: InstantSceneProps): ReactNode {
  const own = useTexts().recording.review;
  const [isOpen, setIsOpen] = useState(false);
  return (
    <div className="review-scene" data-testid="review-scene">
      <Button
        size="lg"
        variant="default"
        aria-expanded={isOpen}
        data-testid="review-scene-toggle"
        onClick={() => {
          setIsOpen(!isOpen);
        }}
      >
        {isOpen ? own.hideScene : own.showScene}
      </Button>
      {isOpen && <OpenScene name={name} instant={instant} />}
    </div>
  );
}

/** A scene that is not drawn for this long is requested and loaded again, as after a restart of the server. */
const RELOAD_AFTER_MS = 10_000;

/** A random key, under which the server keeps the scene of this page. */
const randomKey = (): string =>
  Array.from(crypto.getRandomValues(new Uint8Array(8)), (byte) => byte.toString(16).padStart(2, "0")).join(
    "",
  );

function OpenScene({ name, instant }: InstantSceneProps): ReactNode {
  const texts = useTexts();
  const frame = useRef<HTMLIFrameElement>(null);
  const [key] = useState(randomKey);
  const [isReady, setIsReady] = useState(false);
  const [drawn, setDrawn] = useState<number | null>(null);
  const [rejection, setRejection] = useState<Rejection | null>(null);
  const [attempt, setAttempt] = useState(0);
  const [view, setView] = useState<ViewName>("behind");
  const number = instant?.number ?? null;

  useEffect(() => {
    if (number === null) return;
    const stop = new AbortController();
    const request = async (): Promise<void> => {
      try {
        await putRecordingsByNameScenesByKey({ path: { name, key }, body: { number }, signal: stop.signal });
        if (stop.signal.aborted) return;
        setRejection(null);
        setIsReady(true);
      } catch (error) {
        if (stop.signal.aborted) return;
        if (!(error instanceof Rejection)) throw error;
        setRejection(error);
      }
    };
    void request();
    return () => {
      stop.abort();
    };
  }, [name, key, number, attempt]);

  useEffect(() => {
    const onMessage = (event: MessageEvent<unknown>): void => {
      const isOurs = event.origin === location.origin && event.source === frame.current?.contentWindow;
      if (isOurs && isSceneNote(event.data)) setDrawn(event.data.connected ? event.data.image_number : null);
    };
    addEventListener("message", onMessage);
    return () => {
      removeEventListener("message", onMessage);
    };
  }, []);

  // Image, figures and scene change together: a scene of another image is covered.
  const isCurrent = rejection === null && drawn !== null && drawn === instant?.snapshot.image_number;
  const isMissing = !isCurrent && rejection === null && hasWebGl();
  useEffect(() => {
    if (!isMissing) return;
    const timer = setTimeout(() => {
      setAttempt((before) => before + 1);
    }, RELOAD_AFTER_MS);
    return () => {
      clearTimeout(timer);
    };
  }, [isMissing, attempt, number]);

  const hindrance = isMissing ? "loading" : "unsupported";
  return (
    <>
      <RejectionNote rejection={rejection} />
      <div className="scene-stage" data-testid="review-scene-stage" data-live={isCurrent}>
        {isReady && hasWebGl() && (
          <iframe
            key={attempt}
            ref={frame}
            src={`/scene/review/${key}/`}
            title={texts.scene.title}
            onLoad={() => {
              sendView(frame.current, view);
            }}
          />
        )}
        <SceneViewButtons
          chosen={view}
          onView={(chosen) => {
            setView(chosen);
            sendView(frame.current, chosen);
          }}
        />
        <div className="when-stale">
          <Cover
            urgency="none"
            title={texts.scene[hindrance]}
            sentence={rejection?.message ?? texts.scene[`${hindrance}Hint`]}
          />
        </div>
      </div>
    </>
  );
}
