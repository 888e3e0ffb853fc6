import { useRef, type ReactNode } from "react";
import type { NumbersVerdict } from "../live/assess";
import { useLive, usePainter } from "../live/LiveContext";
import type { Reading } from "../live/reading";
import { shownDuration, shownNumber } from "../live/rounding";
import type { Words } from "../words/en";
import { useWords } from "../words/WordsContext";
import { setData, setText } from "./setText";
import { aheadText, VERDICT_SYMBOL, verdictText } from "./verdictText";

/** The verdict in one word, and what stands behind it; or why there are no numbers. */
export function NumbersState(): ReactNode {
  const words = useWords();
  const { view } = useLive();
  const verdict = useRef<HTMLParagraphElement>(null);
  const since = useRef<HTMLSpanElement>(null);
  const tip = useRef<HTMLSpanElement>(null);
  const ahead = useRef<HTMLParagraphElement>(null);
  const difference = useRef<HTMLParagraphElement>(null);

  usePainter(({ numbers, video, untrackedMs }) => {
    const reading = numbers.live ? numbers.reading : null;
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
    <div className="numbers-state">
      {view.numbers.live ? (
        // Keys, because the painter writes into one of them, and the other must not inherit what it wrote.
        <p className="state-verdict" data-testid="verdict" key="verdict" ref={verdict} />
      ) : (
        <p className="state-bad" data-testid="no-tracking" key="no-tracking">
          <span aria-hidden="true">▲▲</span>{" "}
          {isSeen(view.numbers) ? words.numbers.noNumbers : words.numbers.none}{" "}
          <span className="since" data-testid="untracked-for" ref={since} />
        </p>
      )}
      <p className="state-why">
        {whyWords(view.numbers, words)}
        <span data-testid="tip" ref={tip} />
      </p>
      <p className="state-ahead" data-testid="ahead" ref={ahead} />
      <p className="difference" ref={difference} />
    </div>
  );
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
