import type { ReactNode } from "react";
import type { CameraNoteMessage, LiveProblemMessage } from "../live/messages";
import { sentence } from "../operator/parts/format";
import { RemedyLink } from "../rest/RemedyLink";
import { languageOf, textOf } from "../texts/text";
import { useTexts } from "../texts/TextsContext";

interface ProblemLinesProps {
  problems: readonly LiveProblemMessage[];
  note: CameraNoteMessage | null;
}

/** Problems in the server's words, with their remedies, and its recommendation about the camera. */
export function ProblemLines({ problems, note }: ProblemLinesProps): ReactNode {
  const texts = useTexts();
  return (
    <>
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
    </>
  );
}
