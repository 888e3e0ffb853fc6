import { useRef, type ReactNode, type RefObject } from "react";
import type { NumbersVerdict } from "../live/assess";
import { usePainter, useLive } from "../live/LiveContext";
import type { Reading } from "../live/reading";
import type { DeviationMessage } from "../live/messages";
import { shownDuration, shownFigure, shownNumber } from "../live/rounding";
import type { Words } from "../words/en";
import { useWords } from "../words/WordsContext";
import { Pane } from "./Pane";
import { setData, setText } from "./setText";
import { VERDICT_SYMBOL, aheadText, clearanceMm, verdictText, wallHint } from "./verdictText";

const READINGS = ["entry", "angle", "depth", "toGo", "wall"] as const;
type ReadingName = (typeof READINGS)[number];

const REMOVED = "—";

/** The surgeon's numbers; removed, with words in their place, the moment they are not live. */
export function NumbersPane(): ReactNode {
  const words = useWords();
  const { view } = useLive();
  const pane = useRef<HTMLDivElement>(null);
  const since = useRef<HTMLSpanElement>(null);
  const tip = useRef<HTMLSpanElement>(null);
  const verdict = useRef<HTMLParagraphElement>(null);
  const ahead = useRef<HTMLParagraphElement>(null);
  const difference = useRef<HTMLParagraphElement>(null);

  usePainter(({ numbers, video, untrackedMs }) => {
    setData(pane.current, "live", String(numbers.live));
    const reading = numbers.live ? numbers.reading : null;
    for (const name of READINGS) paintReading(pane.current, name, reading, words);
    paintVerdict(verdict.current, reading, words);
    setText(ahead.current, reading?.judgement ? aheadText(reading.judgement, words) : "");
    setText(since.current, untrackedMs === null ? "" : shownDuration(untrackedMs));
    setText(tip.current, tipText(numbers, words));
    const differ = numbers.live && video.live && numbers.imageNumber !== video.imageNumber;
    setText(
      difference.current,
      differ
        ? `${words.numbers.numbersOf} ${numbers.imageNumber}, ${words.numbers.pictureOf} ${video.imageNumber}`
        : "",
    );
  });

  return (
    <Pane id="numbers" title={words.numbers.title}>
      <div className="numbers" data-testid="numbers" data-live="false" ref={pane}>
        <div className="numbers-state">
          {view.numbers.live ? (
            // Keys, because the painter writes into one of them, and the other must not inherit what it wrote.
            <p className="state-verdict" data-testid="verdict" key="verdict" ref={verdict} />
          ) : (
            <p className="state-bad" data-testid="no-tracking" key="no-tracking">
              <span aria-hidden="true">▲▲</span>{" "}
              {isSeen(view.numbers) ? words.numbers.noNumbers : words.numbers.none} <Since span={since} />
            </p>
          )}
          <p className="state-why">
            {whyWords(view.numbers, words)}
            <span data-testid="tip" ref={tip} />
          </p>
          <p className="state-ahead" data-testid="ahead" ref={ahead} />
        </div>
        {READINGS.map((name) => (
          <div className="reading" data-reading={name} key={name}>
            <p className="reading-name">
              {words.reading[name].name}
              <small data-part="hint">{words.reading[name].hint}</small>
            </p>
            <p className="reading-value">
              <output data-part="value" data-testid={`reading-${name}`} aria-live="off">
                {REMOVED}
              </output>
              <span className="unit">{words.reading[name].unit}</span>
            </p>
          </div>
        ))}
        <p className="difference" ref={difference} />
      </div>
    </Pane>
  );
}

function Since({ span }: { span: RefObject<HTMLSpanElement | null> }): ReactNode {
  return <span className="since" data-testid="untracked-for" ref={span} />;
}

/** Seen, and still without numbers: a plan, a tool or a calibration is missing. */
function isSeen(numbers: NumbersVerdict): boolean {
  return (
    !numbers.live &&
    numbers.cause === "unread" &&
    numbers.unread !== null &&
    numbers.unread.reason !== "MARKER_UNSEEN"
  );
}

function whyWords(numbers: NumbersVerdict, words: Words): string {
  if (numbers.live) return "";
  if (numbers.cause !== "unread")
    return `${words.cause[numbers.cause].state} · ${words.cause[numbers.cause].sentence}`;
  const { unread } = numbers;
  if (unread === null) return "";
  const { state, sentence } = words.absent[unread.reason];
  const why = unread.unseen === null ? sentence : `${unread.marker ?? ""}: ${words.unseen[unread.unseen]}`;
  return `${state} · ${why}`;
}

function tipText(numbers: NumbersVerdict, words: Words): string {
  if (!numbers.live) return "";
  const { tool, tipSdMm, lagMs } = numbers.reading;
  const sd =
    tipSdMm === null ? words.numbers.tipUnknown : `${words.numbers.tip} ${shownNumber(tipSdMm, 2)} mm`;
  const tip = `${tool} · ${sd}`;
  // The age of the image does not hold this delay: it is said beside the numbers that have it.
  return lagMs > 0 ? `${tip} · ${words.numbers.steadied} ${Math.max(Math.round(lagMs), 1)} ms` : tip;
}

function paintReading(
  pane: HTMLElement | null,
  name: ReadingName,
  reading: Reading | null,
  words: Words,
): void {
  const tile = pane?.querySelector<HTMLElement>(`[data-reading=${name}]`);
  if (!tile) return;
  setText(tile.querySelector("[data-part=value]"), reading ? shownFigure(valueOf(reading, name)) : REMOVED);
  setText(tile.querySelector("[data-part=hint]"), hintOf(reading, name, words));
  setData(tile, "past", String(reading !== null && isPast(reading, name)));
}

/** Before a judgement is there, nothing is praised: the word is "tracking", and it is not green. */
function paintVerdict(line: HTMLElement | null, reading: Reading | null, words: Words): void {
  const judgement = reading?.judgement ?? null;
  setData(line, "verdict", judgement?.verdict ?? "none");
  setText(
    line,
    judgement === null
      ? words.numbers.tracking
      : `${VERDICT_SYMBOL[judgement.verdict]} ${verdictText(judgement, words)}`,
  );
}

function isPast({ deviation, judgement }: Reading, name: ReadingName): boolean {
  if (name === "wall") return judgement !== null && (clearanceMm(judgement.clearance.now) ?? 0) < 0;
  return name === "toGo" && deviation.remaining_mm < 0;
}

function valueOf({ deviation, judgement }: Reading, name: ReadingName): number | null {
  switch (name) {
    case "wall":
      return judgement === null ? null : clearanceMm(judgement.clearance.now);
    case "entry":
      return deviation.entry_offset_mm;
    case "angle":
      return deviation.angle_deg;
    case "depth":
      return deviation.depth_mm;
    case "toGo":
      return deviation.remaining_mm;
  }
}

function hintOf(reading: Reading | null, name: ReadingName, words: Words): string {
  const { depthWords } = words;
  if (reading === null) return words.reading[name].hint;
  const deviation: DeviationMessage = reading.deviation;
  if (name === "wall") {
    return reading.judgement === null ? words.reading.wall.hint : wallHint(reading.judgement, words);
  }
  if (name === "entry" && deviation.entry_offset_mm === null) return depthWords.across;
  if (name === "depth") return deviation.depth_mm < 0 ? depthWords.before : depthWords.inside;
  if (name === "toGo" && deviation.remaining_mm < 0) return `▲▲▲ ${depthWords.past}`;
  return words.reading[name].hint;
}
