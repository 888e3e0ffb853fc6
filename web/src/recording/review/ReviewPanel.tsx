import type { ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";
import { clockDuration } from "../recordingText";
import { eventText, SYMBOL } from "./eventText";
import { InstantScene } from "./InstantScene";
import { InstantView } from "./InstantView";
import { Player } from "./Player";
import { ReviewTimeline } from "./ReviewTimeline";
import { clampSpan, type Span } from "./span";
import { SpanButtons } from "./SpanButtons";
import { isWithin, mergedNotes, numberAt } from "./timeline";
import { usePlayback } from "./usePlayback";
import type { ShownInstant } from "./useShownInstant";
import type { LoadedTimeline } from "./useTimeline";

interface ReviewPanelProps {
  /** Name of the recording. */
  name: string;
  loaded: LoadedTimeline;
  span: Span | null;
  onSpan: (span: Span) => void;
  /** The section to export; null for none. */
  piece: Span | null;
  /** The requested image. */
  number: number;
  shown: ShownInstant;
  isLoading: boolean;
  /** Whether playback may choose images; another recording does otherwise. */
  isLeading?: boolean;
  /** Called when somebody, or playback, chooses an image. */
  onNumber: (number: number) => void;
  /** Between timeline and events. */
  children?: ReactNode;
}

/** Image, figures, playback, timeline and events of one recording. */
export function ReviewPanel(props: ReviewPanelProps): ReactNode {
  const {
    name,
    loaded,
    span,
    onSpan,
    piece,
    number,
    shown,
    isLoading,
    isLeading = true,
    onNumber,
    children,
  } = props;
  const { timeline, whole } = loaded;
  const texts = useTexts();
  const own = texts.recording.review;
  const { duration_s: durationS, images } = timeline;
  const [isPlaying, setIsPlaying] = usePlayback({ timeline, whole, shown, isLoading, onNumber });
  if (isPlaying && !isLeading) setIsPlaying(false);
  const seen = span ?? clampSpan({ fromS: 0, toS: durationS }, durationS);
  const atS = shown.instant?.at_s ?? 0;
  const go = (to: number): void => {
    setIsPlaying(false);
    onNumber(Math.min(Math.max(to, 0), images - 1));
  };
  const seek = (toS: number): void => {
    go(numberAt(timeline.curves, toS, images));
  };
  if (images === 0) return <p className="soft">{own.noImages}</p>;
  return (
    <div className="review" data-testid="review">
      {!timeline.is_whole && <p className="review-cut">▲ {own.cut}</p>}
      <InstantView shown={shown} images={images} />
      <InstantScene name={name} instant={shown.instant} />
      <Player
        number={number}
        images={images}
        atS={atS}
        isPlaying={isPlaying}
        onPlay={(on) => {
          if (on) onNumber(number >= images - 1 ? 0 : number);
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
        onSpan={(to) => {
          onSpan(clampSpan(to, durationS));
        }}
      />
      {children}
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
