import { Button, Progress as Bar } from "@mantine/core";
import { useEffectEvent, useLayoutEffect, useRef, useState, type ReactNode } from "react";
import { useLive } from "../../live/LiveContext";
import { deleteLatencyMeasurement } from "../../api";
import { Rejection } from "../../rest/client";
import { interpolate } from "../../texts/interpolate";
import { useTexts } from "../../texts/TextsContext";
import { useMaker } from "../parts/useMaker";
import { measure, type Plan, type Progress, type Result } from "./measure";

interface LatencyScreenProps {
  plan: Plan;
  /** Called once; with null for both if stopped. */
  onOver: (result: Result | null, rejection: Rejection | null) => void;
}

/** Shows the codes over the whole page, below the alarms, until the end, a touch, or unmount. */
export function LatencyScreen({ plan, onOver }: LatencyScreenProps): ReactNode {
  const texts = useTexts().latency;
  const { live } = useLive();
  const madeBy = useMaker();
  const canvas = useRef<HTMLCanvasElement>(null);
  const stop = useRef<HTMLButtonElement>(null);
  const [progress, setProgress] = useState<Progress>({ lookedImages: 0, readImages: 0, doneRatio: 0 });
  const [left] = useState(() => new AbortController());
  const onEnd = useEffectEvent(onOver);
  const onRun = useEffectEvent((drawnOn: HTMLCanvasElement, signal: AbortSignal) =>
    measure({ live, plan, canvas: drawnOn, madeBy, signal, onProgress: setProgress }),
  );

  // Before the codes are seen: a page that is left right then ends its measurement, too.
  useLayoutEffect(() => {
    if (canvas.current === null) return;
    const leaving = new AbortController();
    const { signal } = leaving;
    const end = (): void => {
      if (signal.aborted) return;
      leaving.abort();
      void deleteLatencyMeasurement({ keepalive: true }).catch(() => undefined);
    };
    const leave = (): void => {
      if (signal.aborted) return;
      end();
      onEnd(null, null);
    };
    // A hidden page paints nothing.
    const onVisibility = (): void => {
      if (document.visibilityState === "hidden") leave();
    };
    const onKey = (event: KeyboardEvent): void => {
      if (event.key === "Escape") leave();
    };
    addEventListener("pagehide", leave, { signal });
    addEventListener("keydown", onKey, { signal });
    document.addEventListener("visibilitychange", onVisibility, { signal });
    left.signal.addEventListener("abort", leave, { signal });
    stop.current?.focus();
    onRun(canvas.current, signal)
      .then((result) => {
        if (!signal.aborted) onEnd(result, null);
      })
      .catch((error: unknown) => {
        if (signal.aborted) return;
        if (!(error instanceof Rejection)) throw error;
        onEnd(null, error);
      })
      .finally(() => {
        leaving.abort();
      });
    return end;
  }, [left]);

  return (
    <div className="latency-screen" role="dialog" aria-modal="true" aria-label={texts.title}>
      <canvas ref={canvas} role="img" aria-label={texts.codeAlt} data-testid="latency-code" />
      <div className="latency-words">
        <p role="status" data-testid="latency-read">
          {progress.readImages === 0 ? texts.aim : texts.measuring}{" "}
          {interpolate(texts.read, { read: progress.readImages, looked: progress.lookedImages })}
        </p>
        <Bar value={100 * progress.doneRatio} size="lg" aria-label={texts.measuring} />
        <Button
          size="lg"
          ref={stop}
          data-testid="latency-stop"
          onClick={() => {
            left.abort();
          }}
        >
          {texts.stop}
        </Button>
      </div>
    </div>
  );
}
