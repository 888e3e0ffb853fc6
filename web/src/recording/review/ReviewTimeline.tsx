import { useGesture } from "@use-gesture/react";
import { useEffect, useRef, useState, type ReactNode } from "react";
import type { Texts } from "../../texts/catalogue";
import { textOf } from "../../texts/text";
import { useTexts } from "../../texts/TextsContext";
import type { CurveName } from "../../trend/curve";
import { paintTrend } from "../../trend/paintTrend";
import { clockDuration } from "../recordingText";
import { eventText, SYMBOL } from "./eventText";
import { ratioAt, timeAt, zoomSpan, type Span } from "./span";
import {
  CURVES,
  isWithin,
  maxStepMs,
  rowsOf,
  samplesOf,
  type RecordedEvent,
  type Timeline,
} from "./timeline";

const LANES = ["navigation", "withheld", "alarm"] as const;
/** A shorter drag selects an instant, a longer one a span. */
const MIN_SELECTION_PX = 14;
const WHEEL_PX_A_DOUBLING = 300;
const ROW_PX = 26;
const CURVE_PX = 84;

interface ReviewTimelineProps {
  timeline: Timeline;
  span: Span;
  /** The section to export; null for none. */
  piece: Span | null;
  /** The displayed instant, since the first image. */
  atS: number;
  onSeek: (atS: number) => void;
  onSpan: (span: Span) => void;
}

/** Events and curves: a tap selects an instant, a drag or a pinch the visible span. */
export function ReviewTimeline(props: ReviewTimelineProps): ReactNode {
  const { timeline, span, piece, atS, onSeek, onSpan } = props;
  const texts = useTexts();
  const own = texts.recording.review;
  const plot = useRef<HTMLDivElement>(null);
  const [selection, setSelection] = useState<readonly [number, number] | null>(null);
  const { duration_s: durationS } = timeline;
  const ratioOf = (clientX: number): number => {
    const box = plot.current?.getBoundingClientRect();
    return box === undefined ? 0 : Math.min(Math.max((clientX - box.left) / box.width, 0), 1);
  };

  useGesture(
    {
      onDrag: ({ tap, xy, initial, movement, last, pinching, cancel }) => {
        if (pinching === true) {
          setSelection(null);
          cancel();
          return;
        }
        const [from, to] = [ratioOf(initial[0]), ratioOf(xy[0])].sort((a, b) => a - b) as [number, number];
        const isSelecting = Math.abs(movement[0]) >= MIN_SELECTION_PX;
        setSelection(isSelecting && !last ? [from, to] : null);
        if (tap) onSeek(Math.min(timeAt(span, ratioOf(xy[0])), durationS));
        else if (last && isSelecting) onSpan({ fromS: timeAt(span, from), toS: timeAt(span, to) });
      },
      onPinch: ({ origin, da: [distance], first, memo, event }) => {
        if (event.type === "wheel") return null;
        const before = first ? null : (memo as number | null);
        if (before !== null && before > 0) {
          onSpan(zoomSpan(span, distance / before, timeAt(span, ratioOf(origin[0])), durationS));
        }
        return distance;
      },
      onWheel: ({ event, delta: [, dy] }) => {
        // Without Ctrl the wheel scrolls the page.
        if (!event.ctrlKey) return;
        event.preventDefault();
        const times = 2 ** (-dy / WHEEL_PX_A_DOUBLING);
        onSpan(zoomSpan(span, times, timeAt(span, ratioOf(event.clientX)), durationS));
      },
    },
    {
      target: plot,
      eventOptions: { passive: false },
      drag: { filterTaps: true, axis: "x", pointer: { keys: false } },
    },
  );

  const within = timeline.events.filter((event) => isWithin(event, span));
  const cursor = ratioAt(span, atS);
  const lanes = LANES.map((kind) => ({
    kind,
    // Rows are computed from all events, so that a bar keeps its row when the span changes.
    rows: rowsOf(timeline.events.filter((event) => event.kind === kind)),
  }));
  const heights = [...lanes.map(({ rows }) => rows.length), 1].map((rows) => `${ROW_PX * rows}px`);
  const gridTemplateRows = `${heights.join(" ")} repeat(${CURVES.length}, ${CURVE_PX}px)`;
  return (
    <div className="review-timeline" data-testid="review-timeline">
      <div className="review-names" aria-hidden="true" style={{ gridTemplateRows }}>
        {LANES.map((kind) => (
          <span key={kind} className="review-name">
            {own.kinds[kind]}
          </span>
        ))}
        <span className="review-name">{own.moments}</span>
        {CURVES.map((name) => (
          <span key={name} className="review-name">
            {curveTexts(name, texts).name} <small className="unit">{curveTexts(name, texts).unit}</small>
          </span>
        ))}
      </div>
      <div className="review-plot" ref={plot} style={{ gridTemplateRows }}>
        {lanes.map(({ kind, rows }) => (
          <div key={kind} className="review-lane">
            {rows.map((row, place) =>
              row
                .filter((event) => isWithin(event, span))
                .map((event) => (
                  <Bar
                    key={`${event.code} ${event.from_s}`}
                    event={event}
                    span={span}
                    topPx={ROW_PX * place}
                  />
                )),
            )}
          </div>
        ))}
        <div className="review-lane">
          {within
            .filter(({ to_s }) => to_s === null)
            .map((event) => (
              <span
                key={`${event.kind} ${event.code} ${event.from_s}`}
                className="review-moment"
                style={{ left: percent(ratioAt(span, event.from_s)) }}
                title={eventText(event, texts)}
              >
                {SYMBOL[event.kind]}
              </span>
            ))}
        </div>
        {CURVES.map((name) => (
          <FigureCurve key={name} name={name} timeline={timeline} span={span} />
        ))}
        {piece !== null && <Piece piece={piece} span={span} />}
        {cursor >= 0 && cursor <= 1 && <div className="review-cursor" style={{ left: percent(cursor) }} />}
        {selection !== null && (
          <div
            className="review-selection"
            style={{ left: percent(selection[0]), width: percent(selection[1] - selection[0]) }}
          />
        )}
      </div>
      <p className="review-axis">
        <span>{clockDuration(span.fromS)}</span>
        <span>{clockDuration(timeAt(span, 0.5))}</span>
        <span>{clockDuration(span.toS)}</span>
      </p>
    </div>
  );
}

/** The visible part of the section to export. */
function Piece({ piece, span }: { piece: Span; span: Span }): ReactNode {
  const [from, to] = [piece.fromS, piece.toS].map((atS) => Math.min(Math.max(ratioAt(span, atS), 0), 1)) as [
    number,
    number,
  ];
  return (
    <div
      className="review-piece"
      data-testid="review-piece"
      style={{ left: percent(from), width: percent(to - from) }}
    />
  );
}

const percent = (ratio: number): string => `${100 * ratio}%`;

interface BarProps {
  event: RecordedEvent;
  span: Span;
  topPx: number;
}

function Bar({ event, span, topPx }: BarProps): ReactNode {
  const texts = useTexts();
  const from = Math.max(0, ratioAt(span, event.from_s));
  const to = Math.min(1, ratioAt(span, event.to_s ?? event.from_s));
  return (
    <span
      className="review-bar"
      data-kind={event.kind}
      data-priority={event.priority ?? undefined}
      style={{ top: topPx + 2, left: percent(from), width: percent(Math.max(0, to - from)) }}
      title={eventText(event, texts)}
    >
      {event.title === null ? "" : textOf(event.title, texts)}
    </span>
  );
}

/** Name and unit of a curve, short enough for a phone. */
const curveTexts = (name: CurveName, { reading, recording }: Texts): { name: string; unit: string } =>
  name === "risk" ? recording.review.risk : reading[name];

interface FigureCurveProps {
  name: CurveName;
  timeline: Timeline;
  span: Span;
}

function FigureCurve({ name, timeline, span }: FigureCurveProps): ReactNode {
  const texts = useTexts();
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const element = canvas.current;
    if (element === null) return;
    const paint = (): void => {
      paintTrend(element, name, samplesOf(timeline.curves), {
        nowMs: 1000 * span.toS,
        spanMs: 1000 * (span.toS - span.fromS),
        maxStepMs: maxStepMs(span),
        hasRange: true,
      });
    };
    const watch = new ResizeObserver(paint);
    watch.observe(element);
    return () => {
      watch.disconnect();
    };
  }, [name, timeline, span]);
  return (
    <canvas
      ref={canvas}
      className="review-curve"
      role="img"
      aria-label={`${name === "risk" ? texts.wall.risk : texts.reading[name].name}: ${texts.recording.review.curve}`}
    />
  );
}
