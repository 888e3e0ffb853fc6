import { useEffect, useEffectEvent, useState, type ReactNode } from "react";
import { getRecordingsByNameTimeline } from "../../api";
import { JobProgress } from "../../rest/JobProgress";
import { QueryStatus } from "../../rest/QueryStatus";
import { useJob } from "../../rest/useJob";
import { useQuery } from "../../rest/useQuery";
import { useTexts } from "../../texts/TextsContext";
import { clockDuration } from "../recordingText";
import { CommentForm } from "./CommentForm";
import { eventText, SYMBOL } from "./eventText";
import { Exports } from "./Exports";
import { InstantView } from "./InstantView";
import { Player } from "./Player";
import { ReviewTimeline } from "./ReviewTimeline";
import { clampSpan, type Span } from "./span";
import { SpanButtons } from "./SpanButtons";
import { isWithin, MAX_SAMPLES, mergedNotes, numberAt, type Curves, type Timeline } from "./timeline";
import { usePlayback } from "./usePlayback";
import { useShownInstant } from "./useShownInstant";

/** Review of one recording: indexed on first use, then its timeline and instants. */
export function Review({ name, mayExport }: { name: string; mayExport: boolean }): ReactNode {
  const [span, setSpan] = useState<Span | null>(null);
  const query = useQuery(
    (signal) =>
      getRecordingsByNameTimeline({
        path: { name },
        query: { samples: MAX_SAMPLES, ...(span === null ? {} : { from_s: span.fromS, to_s: span.toS }) },
        signal,
      }),
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
  // While another part is being fetched, the previous curves are shown shifted.
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
  return (
    <Timed
      name={name}
      timeline={timeline}
      whole={whole}
      span={span}
      mayExport={mayExport}
      onSpan={setSpan}
      onChange={refetch}
    />
  );
}

interface TimedProps {
  name: string;
  timeline: Timeline;
  /** Events of the whole recording; the timeline has those of its visible part. */
  whole: Curves;
  span: Span | null;
  mayExport: boolean;
  onSpan: (span: Span) => void;
  onChange: () => void;
}

function Timed(props: TimedProps): ReactNode {
  const { name, timeline, whole, span, mayExport, onSpan, onChange } = props;
  const texts = useTexts();
  const own = texts.recording.review;
  const { duration_s: durationS, images } = timeline;
  const [number, setNumber] = useState(0);
  const [piece, setPiece] = useState<Span | null>(null);
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
      <Player
        number={number}
        images={images}
        atS={atS}
        isPlaying={isPlaying}
        onPlay={(on) => {
          if (on && number >= images - 1) setNumber(0);
          setIsPlaying(on);
        }}
        onNumber={go}
      />
      <SpanButtons span={seen} atS={atS} durationS={durationS} onSpan={onSpan} />
      <ReviewTimeline
        timeline={timeline}
        span={seen}
        piece={piece}
        atS={atS}
        onSeek={seek}
        onSpan={changeSpan}
      />
      <CommentForm name={name} atS={atS} onWritten={onChange} />
      {mayExport && <Exports name={name} atS={atS} durationS={durationS} piece={piece} onPiece={setPiece} />}
      <section aria-label={own.events}>
        <h4>{own.events}</h4>
        <ul className="review-events" data-testid="review-events">
          {mergedNotes(timeline.events)
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
