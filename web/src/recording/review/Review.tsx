import { Button, Slider } from "@mantine/core";
import { useEffect, useEffectEvent, useRef, useState, type ReactNode } from "react";
import { answered, server } from "../../rest/client";
import { JobProgress } from "../../rest/JobProgress";
import { QueryStatus } from "../../rest/QueryStatus";
import { useJob } from "../../rest/useJob";
import { useQuery } from "../../rest/useQuery";
import { useTexts } from "../../texts/TextsContext";
import { clockDuration } from "../recordingText";
import { eventText, SYMBOL } from "./eventText";
import { InstantView } from "./InstantView";
import { ReviewTimeline } from "./ReviewTimeline";
import { clampSpan, moveSpan, zoomSpan, type Span } from "./span";
import { isWithin, MAX_SAMPLES, numberAt, type Curves, type Timeline } from "./timeline";
import { useShownInstant } from "./useShownInstant";

/** One recording: prepared the first time that it is asked for, then its timeline and any instant of it. */
export function Review({ name }: { name: string }): ReactNode {
  const [span, setSpan] = useState<Span | null>(null);
  const query = useQuery(
    (signal) =>
      answered(
        server.GET("/api/recordings/{name}/timeline", {
          params: {
            path: { name },
            query: { samples: MAX_SAMPLES, ...(span === null ? {} : { from_s: span.fromS, to_s: span.toS }) },
          },
          signal,
        }),
      ),
    { key: `${name} ${span?.fromS ?? ""} ${span?.toS ?? ""}` },
  );
  const { data, refetch } = query;
  const { follow, ...followed } = useJob((job) => {
    if (job.state === "done") refetch();
  });
  const [job, setJob] = useState(data?.job ?? null);
  if (data?.job != null && data.job.id !== job?.id) setJob(data.job);
  const onJob = useEffectEvent(follow);
  useEffect(() => {
    if (job !== null) onJob(job);
  }, [job]);
  // While another part is fetched, the curves of the one before are moved.
  const [timeline, setTimeline] = useState<Timeline | null>(null);
  if (data?.timeline != null && data.timeline !== timeline) setTimeline(data.timeline);
  const [whole, setWhole] = useState<Curves | null>(null);
  if (whole === null && timeline !== null) setWhole(timeline.curves);
  if (timeline === null || whole === null) {
    return data?.job == null ? (
      <QueryStatus query={query} />
    ) : (
      <JobProgress followed={{ follow, ...followed }} />
    );
  }
  return <Timed name={name} timeline={timeline} whole={whole} span={span} onSpan={setSpan} />;
}

interface TimedProps {
  name: string;
  timeline: Timeline;
  /** Of the whole recording, while the timeline has those of the part that is seen. */
  whole: Curves;
  span: Span | null;
  onSpan: (span: Span) => void;
}

function Timed({ name, timeline, whole, span, onSpan }: TimedProps): ReactNode {
  const texts = useTexts();
  const own = texts.recording.review;
  const { duration_s: durationS, images } = timeline;
  const [number, setNumber] = useState(0);
  const { shown, isLoading } = useShownInstant(name, number);
  const [isPlaying, setIsPlaying] = usePlayback({ timeline, whole, shown, isLoading, onNumber: setNumber });
  const seen = span ?? clampSpan({ fromS: 0, toS: durationS }, durationS);
  const atS = shown.instant?.at_s ?? 0;
  const go = (to: number): void => {
    setIsPlaying(false);
    setNumber(Math.min(Math.max(to, 0), images - 1));
  };
  const seek = (toS: number): void => {
    go(numberAt(timeline.curves, toS, images));
  };
  const changeSpan = (to: Span): void => {
    onSpan(clampSpan(to, durationS));
  };
  if (images === 0) return <p className="soft">{own.noImages}</p>;
  return (
    <div className="review" data-testid="review">
      {!timeline.is_whole && <p className="review-cut">▲ {own.cut}</p>}
      <InstantView shown={shown} images={images} />
      <div className="review-player">
        <Button
          size="lg"
          variant="default"
          aria-label={own.before}
          onClick={() => {
            go(number - 1);
          }}
          data-testid="review-before"
        >
          ◀|
        </Button>
        <Button
          size="lg"
          className="review-play"
          data-testid="review-play"
          onClick={() => {
            if (!isPlaying && number >= images - 1) setNumber(0);
            setIsPlaying(!isPlaying);
          }}
        >
          {isPlaying ? `❚❚ ${own.pause}` : `▶ ${own.play}`}
        </Button>
        <Button
          size="lg"
          variant="default"
          aria-label={own.after}
          onClick={() => {
            go(number + 1);
          }}
          data-testid="review-after"
        >
          |▶
        </Button>
        <Slider
          className="review-scrubber"
          size="xl"
          thumbSize={40}
          min={0}
          max={Math.max(images - 1, 1)}
          label={null}
          value={number}
          thumbProps={{ "aria-label": own.scrubber, "aria-valuetext": clockDuration(atS) }}
          onChange={go}
        />
      </div>
      <div className="review-zoom">
        <Button
          size="lg"
          variant="default"
          aria-label={own.earlier}
          onClick={() => {
            changeSpan(moveSpan(seen, -0.5, durationS));
          }}
        >
          ←
        </Button>
        <Button
          size="lg"
          variant="default"
          aria-label={own.zoomOut}
          onClick={() => {
            changeSpan(zoomSpan(seen, 0.5, atS, durationS));
          }}
        >
          −
        </Button>
        <Button
          size="lg"
          variant="default"
          aria-label={own.zoomIn}
          data-testid="review-zoom-in"
          onClick={() => {
            changeSpan(zoomSpan(seen, 2, atS, durationS));
          }}
        >
          +
        </Button>
        <Button
          size="lg"
          variant="default"
          aria-label={own.later}
          onClick={() => {
            changeSpan(moveSpan(seen, 0.5, durationS));
          }}
        >
          →
        </Button>
        <Button
          size="lg"
          variant="default"
          data-testid="review-whole"
          onClick={() => {
            changeSpan({ fromS: 0, toS: durationS });
          }}
        >
          {own.whole}
        </Button>
        <span className="soft">{own.gestures}</span>
      </div>
      <ReviewTimeline timeline={timeline} span={seen} atS={atS} onSeek={seek} onSpan={changeSpan} />
      <section aria-label={own.events}>
        <h4>{own.events}</h4>
        <ul className="review-events" data-testid="review-events">
          {timeline.events
            .filter((event) => isWithin(event, seen))
            .map((event) => (
              <li key={`${event.kind} ${event.code} ${event.from_s}`}>
                <button
                  type="button"
                  data-priority={event.priority ?? undefined}
                  onClick={() => {
                    seek(Math.max(event.from_s, 0));
                  }}
                >
                  <time>{clockDuration(event.from_s)}</time>{" "}
                  <span aria-hidden="true">{SYMBOL[event.kind]}</span> {eventText(event, texts)}
                </button>
              </li>
            ))}
        </ul>
      </section>
    </div>
  );
}

interface Playback {
  timeline: Timeline;
  whole: Curves;
  shown: { instant: { at_s: number } | null };
  isLoading: boolean;
  onNumber: (number: number) => void;
}

const FRAME_MS = 40;

/** Plays at the rate of the recording; an image that is late is waited for, and those after it are skipped. */
function usePlayback({
  timeline,
  whole,
  shown,
  isLoading,
  onNumber,
}: Playback): [boolean, (on: boolean) => void] {
  const [isPlaying, setIsPlaying] = useState(false);
  const [, setTick] = useState(0);
  const begin = useRef<{ atMs: number; atS: number } | null>(null);
  const atS = shown.instant?.at_s ?? 0;
  useEffect(() => {
    if (!isPlaying) {
      begin.current = null;
      return;
    }
    if (isLoading) return;
    begin.current ??= { atMs: performance.now(), atS };
    const timer = setTimeout(() => {
      if (begin.current === null) return;
      const toS = begin.current.atS + (performance.now() - begin.current.atMs) / 1000;
      onNumber(numberAt(whole, toS, timeline.images));
      if (toS >= timeline.duration_s) setIsPlaying(false);
      else setTick((before) => before + 1);
    }, FRAME_MS);
    return () => {
      clearTimeout(timer);
    };
  });
  return [isPlaying, setIsPlaying];
}
