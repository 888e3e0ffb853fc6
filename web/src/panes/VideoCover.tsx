import type { ReactNode } from "react";
import type { Cause } from "../live/assess";
import type { LiveProblemMessage } from "../live/messages";
import { sentence } from "../operator/parts/format";
import { languageOf, textOf } from "../texts/text";
import { useTexts } from "../texts/TextsContext";
import { Cover } from "./Cover";

interface VideoCoverProps {
  cause: Cause;
  /** The problem that the server reports, if any. */
  problem?: LiveProblemMessage | undefined;
}

/** Covers the video while there is none, with the reason; plain while the page is loading. */
export function VideoCover({ cause, problem }: VideoCoverProps): ReactNode {
  const texts = useTexts();
  const { state, sentence: reason } = texts.cause[cause];
  if (cause === "connecting") return <Cover urgency="none" title={state} sentence={reason} />;
  const cover = { urgency: "medium", title: texts.video.none, state } as const;
  if (problem === undefined) return <Cover {...cover} sentence={reason} />;
  const text = `${sentence(textOf(problem.message, texts))} ${textOf(problem.remedy, texts)}`;
  return <Cover {...cover} sentence={text} lang={languageOf(problem, texts)} />;
}
