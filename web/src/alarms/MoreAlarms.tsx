import { useEffect, useId, useState, type ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import type { AlarmMessage } from "../live/messages";
import { ProblemLines } from "../panes/ProblemLines";
import { noteOf, problemsOf } from "../panes/problems";
import { sentence } from "../operator/parts/format";
import { languageOf, textOf } from "../texts/text";
import { useTexts } from "../texts/TextsContext";
import { AlarmLine } from "./AlarmSentence";

/** How many alarms and problems are below the highest, and the next of them; a touch lists all in full. */
export function MoreAlarms({ alarms }: { alarms: readonly AlarmMessage[] }): ReactNode {
  const texts = useTexts();
  const { view } = useLive();
  const [isOpen, setOpen] = useState(false);
  const sheet = useId();
  const isConnected = view.link === "open";
  const problems = isConnected ? problemsOf(view) : [];
  const note = isConnected ? noteOf(view) : null;
  const count = alarms.length + problems.length + (note === null ? 0 : 1);
  // The band itself shows the highest alarm or, without alarms, the first problem, but no note.
  const others = alarms.length > 0 || problems.length > 0 ? count - 1 : count;
  const next = alarms[1];
  if (count === 0 && isOpen) setOpen(false);
  useEffect(() => {
    if (!isOpen) return;
    const stop = new AbortController();
    const close = ({ key }: KeyboardEvent): void => {
      if (key === "Escape") setOpen(false);
    };
    addEventListener("keydown", close, { signal: stop.signal });
    return () => {
      stop.abort();
    };
  }, [isOpen]);
  return (
    <>
      <p className="heard-only" aria-live="polite">
        {problems.map((problem) => (
          <span key={problem.code} lang={languageOf(problem, texts)}>
            {sentence(textOf(problem.message, texts))}{" "}
          </span>
        ))}
        {note !== null && sentence(textOf(note.message, texts))}
      </p>
      {count > 0 && (
        <button
          type="button"
          className="alarms-more"
          data-testid="alarms-more"
          data-priority={next?.priority}
          data-state={next?.state}
          aria-expanded={isOpen}
          aria-controls={sheet}
          onClick={() => {
            setOpen(!isOpen);
          }}
        >
          {others > 0 ? (
            <>
              <span className="heard-only">{texts.alarms.all}</span>
              <span className="alarms-count">+{others}</span>
            </>
          ) : (
            <span className="alarms-details">{texts.alarms.details}</span>
          )}{" "}
          <span aria-hidden="true">{isOpen ? "▴" : "▾"}</span>{" "}
          {next !== undefined && <span className="alarms-next">{textOf(next.title, texts)}</span>}
        </button>
      )}
      {isOpen && (
        <div className="alarms-sheet" id={sheet} role="region" aria-label={texts.alarms.all} tabIndex={0}>
          <ul className="alarms-list" data-testid="alarms-all">
            {alarms.map((alarm) => (
              <li
                key={alarm.number}
                data-priority={alarm.priority}
                data-state={alarm.state}
                data-condition={alarm.condition}
              >
                <AlarmLine alarm={alarm} />
              </li>
            ))}
          </ul>
          <ProblemLines problems={problems} note={note} />
        </div>
      )}
    </>
  );
}
