import type { ReactNode } from "react";
import { sentence } from "../operator/parts/format";
import { RemedyLink } from "../rest/RemedyLink";
import { useLive } from "../live/LiveContext";
import { useTexts } from "../texts/TextsContext";
import { languageOf, textOf } from "../texts/text";
import { noteOf, problemsOf } from "./problems";

/** Problems in the server's words, with their remedies; nothing without a problem. */
export function AlertBand(): ReactNode {
  const texts = useTexts();
  const { view } = useLive();
  const problems = view.link === "open" ? problemsOf(view) : [];
  const note = view.link === "open" ? noteOf(view) : null;
  return (
    <div className="alerts" role="region" aria-label={texts.alerts.title} aria-live="polite">
      {problems.map((problem) => (
        <p className="alert" key={problem.code} data-testid="alert">
          <span aria-hidden="true">▲▲</span>
          <strong lang={languageOf(problem, texts)}>{sentence(textOf(problem.message, texts))}</strong>
          <span>
            {texts.alerts.remedy}{" "}
            <span lang={languageOf(problem, texts)}>{textOf(problem.remedy, texts)}</span>{" "}
            <code>{problem.code}</code>
          </span>
          <RemedyLink code={problem.code} />
        </p>
      ))}
      {note !== null && (
        <p className="alert note" data-testid="camera-note">
          <span aria-hidden="true">▲</span>
          <strong>{textOf(note.message, texts)}</strong>
          <span>{textOf(note.remedy, texts)}</span>
        </p>
      )}
    </div>
  );
}
