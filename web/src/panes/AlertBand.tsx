import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { useWords } from "../words/WordsContext";
import { textOf } from "../words/text";
import { noteOf, problemsOf } from "./problems";

/** What is wrong, in the server's words: what happened, and what to do. Nothing wrong, no band. */
export function AlertBand(): ReactNode {
  const words = useWords();
  const { view } = useLive();
  const problems = view.link === "open" ? problemsOf(view) : [];
  const note = view.link === "open" ? noteOf(view) : null;
  return (
    <div className="alerts" role="region" aria-label={words.alerts.title} aria-live="polite">
      {problems.map(({ code, message, remedy }) => (
        <p className="alert" key={code} data-testid="alert">
          <span aria-hidden="true">▲▲</span>
          {/* The server speaks English. */}
          <strong lang="en">{message}.</strong>
          <span>
            {words.alerts.remedy} <span lang="en">{remedy}</span> <code>{code}</code>
          </span>
        </p>
      ))}
      {note !== null && (
        <p className="alert note" data-testid="camera-note">
          <span aria-hidden="true">▲</span>
          <strong>{textOf(note.message, words)}</strong>
          <span>{textOf(note.remedy, words)}</span>
        </p>
      )}
    </div>
  );
}
