import { useEffect, useRef, type ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";
import { ComparisonBar } from "./ComparisonBar";
import { ReviewPanel } from "./ReviewPanel";
import { TimelineStatus } from "./TimelineStatus";
import { useLinkedInstants } from "./useLinkedInstants";
import { useTimeline, type LoadedTimeline, type TimelineState } from "./useTimeline";

interface ReviewPairProps {
  names: readonly [string, string];
  titles: readonly [string, string];
  onClose: () => void;
}

/** Two recordings side by side, each with its own timeline; moving in one moves the other. */
export function ReviewPair({ names, titles, onClose }: ReviewPairProps): ReactNode {
  const [first, second] = [useTimeline(names[0]), useTimeline(names[1])];
  // Instants can be read only of indexed recordings.
  if (first.loaded === null) return <TimelineStatus state={first} />;
  if (second.loaded === null) return <TimelineStatus state={second} />;
  return (
    <LoadedPair
      names={names}
      titles={titles}
      states={[first, second]}
      loaded={[first.loaded, second.loaded]}
      onClose={onClose}
    />
  );
}

interface LoadedPairProps extends ReviewPairProps {
  states: readonly [TimelineState, TimelineState];
  loaded: readonly [LoadedTimeline, LoadedTimeline];
}

function LoadedPair({ names, titles, states, loaded, onClose }: LoadedPairProps): ReactNode {
  const own = useTexts().recording.review.pair;
  const linked = useLinkedInstants(names);
  const section = useRef<HTMLElement>(null);
  // Below the list of recordings both images would begin outside of a tablet's screen.
  useEffect(() => {
    section.current?.scrollIntoView({ block: "start" });
  }, []);
  return (
    <section ref={section} className="review-compared" aria-label={own.title} data-testid="review-pair">
      <ComparisonBar linked={linked} titles={titles} onClose={onClose} />
      <div className="review-pair">
        {([0, 1] as const).map((place) => {
          const { number, shown, isLoading, isLeading, onNumber } = linked.sides[place];
          return (
            <section
              key={names[place]}
              aria-label={titles[place]}
              data-testid={`review-side-${String(place)}`}
            >
              <h4>{titles[place]}</h4>
              <ReviewPanel
                name={names[place]}
                loaded={loaded[place]}
                span={states[place].span}
                onSpan={states[place].setSpan}
                piece={null}
                number={number}
                shown={shown}
                isLoading={isLoading}
                isLeading={isLeading}
                onNumber={onNumber}
              />
            </section>
          );
        })}
      </div>
    </section>
  );
}
