import { useRef, type ReactNode } from "react";
import type { NumbersVerdict } from "../live/assess";
import { useLive, usePainter } from "../live/LiveContext";
import type { HeadlineMessage } from "../live/messages";
import { formatDuration } from "../live/rounding";
import type { Texts } from "../texts/en";
import { keepUnits } from "../texts/keepUnits";
import { textOf } from "../texts/text";
import { useTexts } from "../texts/TextsContext";
import { ProposedChannel } from "./ProposedChannel";
import { setData, setText } from "./setText";
import { errorText, lagText, riskText, TONE_SYMBOL } from "./verdictText";

/** Headline and detail of the displayed figures, or why there are none. */
export function NumbersState({ children }: { children?: ReactNode }): ReactNode {
  const texts = useTexts();
  const { view } = useLive();
  const headline = useRef<HTMLParagraphElement>(null);
  const detail = useRef<HTMLParagraphElement>(null);
  const event = useRef<HTMLParagraphElement>(null);
  const since = useRef<HTMLSpanElement>(null);
  const error = useRef<HTMLParagraphElement>(null);
  const risk = useRef<HTMLParagraphElement>(null);

  usePainter(({ numbers, untrackedMs, newest }) => {
    const live = numbers.live ? numbers.reading.headline : null;
    paintHeadline(headline.current, live, texts);
    setLine(detail.current, live === null ? reasonTexts(numbers, texts) : textOf(live.detail, texts));
    setLine(event.current, eventText(numbers, texts));
    setLine(risk.current, numbers.live ? riskText(numbers.reading.assessment, texts) : "");
    setText(since.current, untrackedMs === null ? "" : formatDuration(untrackedMs));
    setLine(error.current, errorLine(numbers, newest?.source.name ?? "", texts));
  });

  return (
    <div className="numbers-state">
      {view.numbers.live ? (
        // Keys keep React from reusing an element that the painter has written to.
        <p className="state-verdict" data-testid="verdict" key="verdict" ref={headline} />
      ) : (
        <p className="state-bad" data-testid="no-tracking" key="no-tracking">
          <span aria-hidden="true">▲▲</span> {noneTitle(view.numbers, texts)}{" "}
          <span className="since" data-testid="untracked-for" ref={since} />
        </p>
      )}
      <p className="state-why" data-testid="headline-detail" ref={detail} />
      <p className="state-event" data-testid="headline-event" ref={event} />
      <p className="state-ahead" data-testid="ahead" ref={risk} />
      <p className="state-ahead" data-testid="tip" ref={error} />
      <ProposedChannel />
      {children}
    </div>
  );
}

/** The newest image's reason for missing figures, if the page displays no image's figures. */
function noneTitle(numbers: NumbersVerdict, texts: Texts): string {
  if (numbers.live || numbers.unread === null) return texts.numbers.none;
  return textOf(numbers.unread.headline.title, texts);
}

function reasonTexts(numbers: NumbersVerdict, texts: Texts): string {
  if (numbers.live) return "";
  if (numbers.cause !== "unread") {
    const { state, sentence } = texts.cause[numbers.cause];
    return `${state} · ${sentence}`;
  }
  return numbers.unread === null ? "" : textOf(numbers.unread.headline.detail, texts);
}

/** Unacknowledged alarms that are over or not observed, beside the headline as in the video. */
function eventText(numbers: NumbersVerdict, texts: Texts): string {
  const headline = numbers.live ? numbers.reading.headline : numbers.unread?.headline;
  return headline === undefined ? "" : textOf(headline.event, texts);
}

function errorLine(numbers: NumbersVerdict, source: string, texts: Texts): string {
  if (!numbers.live) return "";
  const { tool, assessment, lagMs } = numbers.reading;
  const lag = lagText(assessment, source, texts);
  const line = `${tool} · ${errorText(assessment, texts)}${lag === "" ? "" : ` · ${lag}`}`;
  // The image's age does not include this delay, so it is shown beside the affected numbers.
  return lagMs > 0 ? `${line} · ${texts.numbers.steadied} ${Math.max(Math.round(lagMs), 1)} ms` : line;
}

function setLine(line: HTMLElement | null, text: string): void {
  setText(line, keepUnits(text));
}

function paintHeadline(line: HTMLElement | null, headline: HeadlineMessage | null, texts: Texts): void {
  setData(line, "tone", headline?.tone ?? "none");
  setData(line, "verdict", headline?.verdict ?? "none");
  setLine(line, headline === null ? "" : `${TONE_SYMBOL[headline.tone]} ${textOf(headline.title, texts)}`);
}
