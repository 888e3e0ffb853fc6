import type { ReactNode } from "react";
import type { Cause } from "../live/assess";
import type { ProblemMessage } from "../live/messages";
import { useTexts } from "../texts/TextsContext";
import { Cover } from "./Cover";

interface VideoCoverProps {
  cause: Cause;
  /** The problem that the server reports, if any. */
  problem?: ProblemMessage | undefined;
}

/** Covers the video while there is none, with the reason; plain while the page is loading. */
export function VideoCover({ cause, problem }: VideoCoverProps): ReactNode {
  const texts = useTexts();
  const { state, sentence } = texts.cause[cause];
  if (cause === "connecting") return <Cover urgency="none" title={state} sentence={sentence} />;
  const text = problem === undefined ? sentence : `${problem.message}. ${problem.remedy}`;
  return <Cover urgency="medium" title={texts.video.none} state={state} sentence={text} />;
}
